// A text's hash, as it stands for what the text describes: runs, specimens.
#pragma once

#include <string>

namespace feldspar {

/// 32 hexadecimal digits: different texts have, for all that will ever be seen, different ones.
std::string hash_of_text(const std::string& text);

}  // namespace feldspar
