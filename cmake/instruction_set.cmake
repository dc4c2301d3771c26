# Level of x86-64 that MELTRAY_ISA comes to on this compiler: 1 (none) to 4, for the check at program start.
function(meltray_isa_level result)
  set(level 1)
  if(MELTRAY_ISA STREQUAL "none")
    set(flags "")
  else()
    set(flags -march=${MELTRAY_ISA})
  endif()
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${flags} -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros)
  if(macros MATCHES "__AVX512F__")
    set(level 4)
  elseif(macros MATCHES "__AVX2__")
    set(level 3)
  elseif(macros MATCHES "__SSE4_2__")
    set(level 2)
  endif()
  set(${result} ${level} PARENT_SCOPE)
endfunction()

# The loops of AcousticPass once more for every level above that of the program: the program takes the best that
# its processor has. Adds them to a room; nothing in them is shared with code of another level.
function(meltray_acoustic_kernels room)
  set(source ${PROJECT_SOURCE_DIR}/src/terms/pressure/acoustic_kernel.cpp)
  meltray_isa_level(level)
  set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS
    "MELTRAY_INSTRUCTIONS=baseline;MELTRAY_INSTRUCTIONS_NAME=\"${MELTRAY_ISA}\"")
  # Of the compiler's own header for vectors.
  set(quiet -Wno-maybe-uninitialized -Wno-uninitialized)
  set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${quiet}")
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    return()
  endif()
  foreach(higher 3 4)
    if(level LESS higher)
      set(copy ${PROJECT_BINARY_DIR}/acoustic_kernel_v${higher}.cpp)
      file(CONFIGURE OUTPUT ${copy} CONTENT "#include \"${source}\"\n")
      set_source_files_properties(${copy} PROPERTIES
        COMPILE_OPTIONS "-march=x86-64-v${higher};${quiet}"
        COMPILE_DEFINITIONS
          "MELTRAY_INSTRUCTIONS=v${higher};MELTRAY_INSTRUCTIONS_NAME=\"x86-64-v${higher}\"")
      target_sources(${room} PRIVATE ${copy})
      set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/terms/pressure/acoustic_choice.cpp APPEND PROPERTY
        COMPILE_DEFINITIONS MELTRAY_WITH_V${higher})
    endif()
  endforeach()
endfunction()
