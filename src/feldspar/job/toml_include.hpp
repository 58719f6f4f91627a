// The one way in which Feldspar includes toml++: compiled into toml_reader.cpp, its assertions off. With them on, a file
// that ends in a lone `[` aborts the program instead of being a syntax error.
#pragma once

#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 0
#pragma push_macro("NDEBUG")
#undef NDEBUG  // with NDEBUG toml++ would turn some assertions into assumptions of the optimiser
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")
