// Numbers and paragraphs for a terminal.
#pragma once

#include <string>

namespace feldspar {

/// Four digits or so; "-" for not-a-number.
std::string table_number(double value);

/// Words broken into lines of about 110 letters, each behind the indent.
std::string wrapped_text(const std::string& text, const std::string& indent = {});

}  // namespace feldspar
