// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace spdlog {
class logger;
}

namespace meltray::app {

/// log.txt of a run folder: what happened when, for people. A failing log never stops a run.
class Log {
 public:
  explicit Log(const std::filesystem::path& file);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  void info(std::string_view text);
  void warn(std::string_view text);
  void error(std::string_view text);

 private:
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace meltray::app
