# cmake -D SOURCE=... -D HEADER=... -P git_hash.cmake: writes the hash of the source's commit, empty without one, where it
# has changed. Run at every build, so that results name the source they were made with.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10
                OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(hash "")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define MELTRAY_GIT_HASH \"${hash}\"\n")
