// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meltray {

/// Named values that go into a checkpoint and come back from it. The same code describes both directions:
/// `archive.value("time_s", time_)` writes when saving and overwrites `time_` when loading.
/// Names are unique within an archive and may contain '/' for groups.
class Archive {
 public:
  virtual ~Archive() = default;
  virtual bool loading() const = 0;
  virtual void value(std::string_view name, double& v) = 0;
  virtual void value(std::string_view name, std::int64_t& v) = 0;
  virtual void value(std::string_view name, std::string& v) = 0;
  virtual void values(std::string_view name, std::vector<double>& v) = 0;
  virtual void values(std::string_view name, std::vector<std::uint8_t>& v) = 0;
  virtual void values(std::string_view name, std::vector<std::int32_t>& v) = 0;
};

}  // namespace meltray
