// Texts that a command prints or writes as a whole.
#pragma once

#include <string>

#include "feldspar/base/error.hpp"

namespace feldspar {

/// Prints a text. @throws OutputError if it could not be printed to its end
ExitCode print_whole(const std::string& text);

/// Writes a text to a new file, never an existing one. @param option  that names the file. @throws InputError if there is no such
/// file to be made, OutputError if it could not be written to its end; then there is no file
void write_whole(const std::string& text, const std::string& path, const std::string& option);

}  // namespace feldspar
