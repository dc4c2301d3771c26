// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

/// Case texts that the tests vary.
namespace case_samples {

/// A melt pool with all that a laser weld needs but the laser; 3-D.
inline const std::string weld = R"(title = "sample"

[domain]
min_m = [0.0, -4e-4, -8e-4]
max_m = [1e-3, 4e-4, 4e-4]
spacing_m = 5e-5

[faces.z_min]
kind = "wall"

[[bodies]]
shape = "box"
min_m = [0.0, -4e-4, -8e-4]
max_m = [1e-3, 4e-4, 0.0]

[material]
name = "iron"

[terms]
conduction = true
pressure = true
viscosity = true
surface_tension = true
melting = true

[laser]
power_w = 1000

[time]
end_s = 1e-3

[output]
interval_s = 1e-5
)";

/// Heat only, in the x-z plane.
inline const std::string flat = R"([domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [1e-3, 5e-4]
spacing_m = 5e-5

[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [1e-3, 5e-4]

[material]
name = "iron"

[terms]
conduction = true

[time]
end_s = 1e-3

[output]
interval_s = 1e-5
)";

/// `text` with `from` replaced; `from` has to be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("sample has no '" + from + "'");
  return text.replace(at, from.size(), to);
}

/// `text` with a line added below a section header.
inline std::string added(const std::string& text, const std::string& section, const std::string& line) {
  return replaced(text, "[" + section + "]\n", "[" + section + "]\n" + line + "\n");
}

}  // namespace case_samples
