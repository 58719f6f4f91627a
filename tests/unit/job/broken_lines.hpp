// Files broken line by line: every value of a wrong type, every key and head of a table misspelt.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace feldspar {

struct BrokenLine {
    std::string text;     ///< the file with this line broken
    std::string written;  ///< the line as it is now
    int line = 0;
};

/// One file for each `key = value` of `text` with a date for its value, one with a letter less in its key (keys of one or two
/// letters keep them), and one for each head of a table with a letter less in its last name.
inline std::vector<BrokenLine> broken_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::stringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    std::vector<BrokenLine> broken;
    const auto add = [&](std::size_t at, const std::string& with) {
        BrokenLine one{{}, with, static_cast<int>(at) + 1};
        for (std::size_t i = 0; i < lines.size(); ++i) one.text += (i == at ? with : lines[i]) + "\n";
        broken.push_back(one);
    };
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].starts_with('[')) {
            std::string head = lines[i];
            add(i, head.erase(head.find_last_of("[.") + 1, 1));
        }
        const std::size_t equals = lines[i].find(" = ");
        if (equals == std::string::npos || lines[i].front() == '#') continue;
        add(i, lines[i].substr(0, equals) + " = 1979-05-27");
        if (equals > 2) add(i, lines[i].substr(1));
    }
    return broken;
}

}  // namespace feldspar
