// What the fuzzing targets share. A target is a function that takes any bytes as one kind of input and reads them as the program
// would. It may read or refuse them; that is all it may do: a crash, a loop without end, memory without bound, or an error of
// another kind is a fault.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "../temporary_folder.hpp"
#include "feldspar/base/error.hpp"

namespace feldspar::fuzz {

/// Ends the target: the input has shown a fault. The fuzzer keeps the input, and the test of the corpus fails.
struct Fault : std::logic_error {
    using std::logic_error::logic_error;
};

/// Calls `read`, which may throw an InputError that says what is wrong. @return whether it was read
template <class Read>
bool read_or_refuse(Read&& read) {
    try {
        read();
        return true;
    } catch (const InputError& error) {
        if (error.problem().empty()) throw Fault("an InputError says nothing");
        if (std::string_view(error.what()).size() > 1'000'000)
            throw Fault("the message of an InputError has more than a million characters");
        return false;
    }
}

/// A file of this name with these bytes, in a folder that goes with the process. The one before it is replaced.
inline std::filesystem::path file_with(const std::string& name, std::string_view bytes) {
    static const TemporaryFolder folder;
    const std::filesystem::path file = folder / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

/// The bytes with these edits: of every 12 bytes 4 say where and 8 what is put there; the rest, if there is any, where the bytes
/// end.
inline std::string edited(std::string bytes, std::string_view edits) {
    const auto place = [&](std::string_view text) {
        std::size_t at = 0;
        for (const char c : text) at = at << 8 | static_cast<unsigned char>(c);
        return bytes.empty() ? 0 : at % bytes.size();
    };
    for (; edits.size() >= 12; edits.remove_prefix(12)) {
        const std::size_t at = place(edits.substr(0, 4));
        for (std::size_t i = 0; i < 8 && at + i < bytes.size(); ++i) bytes[at + i] = edits[4 + i];
    }
    if (!edits.empty()) bytes.resize(place(edits.substr(0, 4)));
    return bytes;
}

/// The first line of an input, which says how the rest is to be taken; it is cut off.
inline std::string_view first_line(std::string_view& input) {
    const std::size_t end = std::min(input.find('\n'), input.size());
    const std::string_view line = input.substr(0, end);
    input.remove_prefix(std::min(end + 1, input.size()));
    return line;
}

}  // namespace feldspar::fuzz
