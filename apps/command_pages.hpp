// Manual pages and completions, written from the same texts as the help of the commands.
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"

namespace feldspar {

/// The manual page of a command in roff, section 1. @param name  "run", "study status"; empty: the page of the whole program.
/// @throws InputError if there is no such command
std::string manual_page(const CommandLine& line, const std::string& name);

/// The same by the name of the page.
std::string manual_page_named(const CommandLine& line, const std::string& page);

/// The names of all pages, such as "feldspar" and "feldspar-study-status".
std::vector<std::string> manual_names(const CommandLine& line);

/// The completion of a shell: "bash", "zsh" or "fish".
std::string completion(const CommandLine& line, const std::string& shell);

}  // namespace feldspar
