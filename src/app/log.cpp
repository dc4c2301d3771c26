// SPDX-License-Identifier: MIT
#include "app/log.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include "meltray/core/errors.hpp"

namespace meltray::app {

Log::Log(const std::filesystem::path& file) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string(), false);
    logger_ = std::make_shared<spdlog::logger>("run", sink);
  } catch (const spdlog::spdlog_ex& e) {
    throw IoError(file.string() + ": " + e.what());
  }
  logger_->set_pattern("%Y-%m-%d %H:%M:%S %l: %v");
  logger_->flush_on(spdlog::level::info);
  // Write errors of the log itself are dropped: the data files report a full disk.
  logger_->set_error_handler([](const std::string&) {});
}

Log::~Log() = default;
void Log::info(std::string_view text) {
  logger_->info(text);
}
void Log::warn(std::string_view text) {
  logger_->warn(text);
}
void Log::error(std::string_view text) {
  logger_->error(text);
}

}  // namespace meltray::app
