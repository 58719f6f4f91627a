// The terminal that the program prints to.
#pragma once

#include <cstddef>

namespace feldspar {

/// Columns of the terminal on standard output; 0 if that is a file, a pipe, or a terminal that does not say. COLUMNS in the
/// environment, if it is a number from 20 to 10000, goes before the terminal.
std::size_t output_columns();

/// The same of standard error.
std::size_t error_columns();

}  // namespace feldspar
