#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace feldspar {
namespace {

std::size_t columns_of(int descriptor) {
    if (isatty(descriptor) != 1) return 0;
    if (const char* given = std::getenv("COLUMNS")) {
        const std::string_view text = given;
        std::size_t columns = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
        if (error == std::errc{} && end == text.data() + text.size() && columns >= 20 && columns <= 10000) return columns;
    }
    struct winsize size {};
    return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col >= 20 ? size.ws_col : 0;
}

}  // namespace

std::size_t output_columns() { return columns_of(STDOUT_FILENO); }

std::size_t error_columns() { return columns_of(STDERR_FILENO); }

}  // namespace feldspar
