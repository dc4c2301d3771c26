// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meltray {

/// `word` as one word of a shell's command line, for commands that are printed to be pasted: as it is where
/// no shell reads more into it, in single quotes otherwise.
inline std::string shell_word(std::string_view word) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) {
    // Nothing escapes a quote within quotes: they end, and begin again behind it.
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  }
  return quoted + "'";
}

}  // namespace meltray
