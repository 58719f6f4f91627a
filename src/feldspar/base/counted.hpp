// A number of things in words.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace feldspar {

/// "1 packing", "3 packings".
std::string counted(std::integral auto count, std::string_view thing) {
    return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

}  // namespace feldspar
