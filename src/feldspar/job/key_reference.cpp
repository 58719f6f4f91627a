#include "feldspar/job/key_reference.hpp"

#include <fmt/format.h>

#include "feldspar/base/error.hpp"

namespace feldspar {
namespace {

constexpr std::string_view begin_mark = "<!-- keys of ", begin_end = " -->\n", end_mark = "<!-- end of keys -->";

bool is_value(const JobKey& key) { return key.usual.is_value(); }

// What is allowed, words of a file as code.
std::string allowed_cell(const JobKey& key) {
    std::string cell;
    bool code = false;
    for (const char c : allowed(key)) {
        if (c == '"' && !code) cell += '`';
        cell += c;
        if (c == '"' && code) cell += '`';
        if (c == '"') code = !code;
    }
    return cell;
}

}  // namespace

std::string key_reference(const KeyTable& table) {
    std::string text = table.path.empty() ? "| key | meaning | allowed | default |\n"
                                          : fmt::format("| key of `{}` | meaning | allowed | default |\n", table.head);
    text += "|---|---|---|---|\n";
    for (const JobKey& key : table.keys) {
        const std::string applies = applies_text(key), usual = usual_text(key);
        text += fmt::format("| `{}` | {}{} | {} | {} |\n", key.name, key.meaning,
                            applies.empty() ? "" : fmt::format(". Only {}", applies), allowed_cell(key),
                            is_value(key) ? fmt::format("`{}`", usual) : usual);
    }
    return text;
}

std::string key_reference() {
    std::string text = "# Keys of job files\n";
    for (const KeyTable& table : job_tables())
        text += fmt::format("\n## {}\n\n{}",
                            table.path.empty() ? "The file" : fmt::format("{}: {}", table.head, without_markup(table.meaning)),
                            key_reference(table));
    return text;
}

std::string with_key_reference(std::string_view text) {
    std::string written;
    for (std::size_t at = 0;;) {
        const std::size_t begin = text.find(begin_mark, at);
        if (begin == std::string_view::npos) return written + std::string(text.substr(at));
        const std::size_t path = begin + begin_mark.size(), path_end = text.find(begin_end, path),
                          end = text.find(end_mark, path);
        if (path_end == std::string_view::npos || end == std::string_view::npos || end < path_end)
            throw InputError({}, "a mark of keys has no end");
        const std::string_view name = text.substr(path, path_end - path);
        written += text.substr(at, path_end + begin_end.size() - at);
        bool found = false;
        for (const KeyTable& table : job_tables())
            if (table.path == name || (table.path.empty() && name == "file")) {
                written += key_reference(table);
                found = true;
            }
        if (!found) throw InputError({}, fmt::format("'{}' is not a table of a job", name));
        at = end;
    }
}

}  // namespace feldspar
