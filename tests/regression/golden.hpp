// Recorded ("golden") values of the regression tests: a file of cases and what they gave, compared, or written again when asked.
//
//   FELDSPAR_RECORD=1 ./regression_test     writes the files anew and prints every case that moved
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "../temporary_folder.hpp"

namespace feldspar::golden {

/// Whether this program is to write down what it gets.
inline bool recording() {
    const char* wanted = std::getenv("FELDSPAR_RECORD");
    return wanted != nullptr && *wanted != '\0' && std::string(wanted) != "0";
}

inline std::filesystem::path folder() { return std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/regression"; }

inline std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

/// What to do with a case that moved; once a program.
inline const char* what_now() {
    static bool said = false;
    if (said) return "";
    said = true;
    return "\nThese numbers are recorded, not derived: they say that something moved, not which is right.\n"
           "If this change was not meant to move results, it is a fault: find what moved them.\n"
           "If it was, say in CHANGELOG.md which results move and why, and record again, in the same commit:\n"
           "    FELDSPAR_RECORD=1 build/release/regression_test\n"
           "The difference of the recorded files then shows which cases moved; those that were not meant to must not.\n";
}

/// The cases of one file. Kept sorted, so that a difference of two versions can be read.
class File {
public:
    enum class Kind {
        table,  ///< CSV: a line a case, the first column names it
        texts   ///< a heading "==== case" and lines
    };

    /// @param columns  of a table: names of all columns but the first
    File(const std::string& name, Kind kind, std::string columns = {})
        : path_(folder() / name), kind_(kind), columns_(std::move(columns)) {
        for (const auto& [key, value] : read()) recorded_.emplace(key, value);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (!recording() || (moved_ == 0 && new_ == 0)) return;
        std::string text =
            fmt::format("{}: {} of {} cases moved, {} are new", path_.filename().string(), moved_, recorded_.size(), new_);
        for (const auto& [column, count] : moved_columns_) text += fmt::format("; {} moved in {}", column, count);
        fmt::print("{}\n", text);
    }

    /// Compares what a case gave with what is recorded; or takes it down.
    void expect(const std::string& key, const std::string& value) {
        const auto old = recorded_.find(key);
        if (old != recorded_.end() && old->second == value) return;
        const std::string message =
            old == recorded_.end()
                ? fmt::format("new case in {}: {}\n{}", path_.filename().string(), key, shown(value))
                : fmt::format("moved in {}: {}\n{}", path_.filename().string(), key, difference(old->second, value));
        if (!recording()) {
            ADD_FAILURE() << message << what_now();
            return;
        }
        fmt::print("{}", message);
        ++(old == recorded_.end() ? new_ : moved_);
        if (kind_ == Kind::table && old != recorded_.end()) count_columns(old->second, value);
        recorded_[key] = value;
        write();
    }

    /// Expects that nothing is recorded of cases that are not among `keys`; or drops it.
    void expect_only(const std::set<std::string>& keys) {
        std::vector<std::string> gone;
        for (const auto& [key, value] : recorded_)
            if (keys.count(key) == 0) gone.push_back(key);
        for (const std::string& key : gone) {
            if (!recording()) {
                ADD_FAILURE() << "recorded in " << path_.filename() << ", but no case any more: " << key << "\n" << what_now();
                continue;
            }
            fmt::print("no case any more in {}: {}\n", path_.filename().string(), key);
            recorded_.erase(key);
        }
        if (recording() && !gone.empty()) write();
    }

private:
    std::map<std::string, std::string> read() const {
        std::map<std::string, std::string> found;
        const std::vector<std::string> lines = split(read_text(path_), '\n');
        std::string heading;
        for (std::size_t i = kind_ == Kind::table ? 1 : 0; i < lines.size(); ++i) {
            if (kind_ == Kind::table) {
                const std::size_t comma = lines[i].find(',');
                found[lines[i].substr(0, comma)] = comma == std::string::npos ? "" : lines[i].substr(comma + 1);
            } else if (lines[i].starts_with(mark)) {
                heading = lines[i].substr(mark.size());
                found[heading];
            } else {
                found[heading] += lines[i] + "\n";
            }
        }
        return found;
    }

    void write() const {
        std::string text = kind_ == Kind::table ? fmt::format("case,{}\n", columns_) : "";
        for (const auto& [key, value] : recorded_)
            text += kind_ == Kind::table ? fmt::format("{},{}\n", key, value) : fmt::format("{}{}\n{}", mark, key, value);
        write_text(path_, text);
    }

    std::string shown(const std::string& value) const {
        return kind_ == Kind::table ? fmt::format("    {}\n    {}\n", columns_, value) : "";
    }

    void count_columns(const std::string& old_value, const std::string& new_value) {
        const std::vector<std::string> names = split(columns_, ','), olds = split(old_value, ','), news = split(new_value, ',');
        for (std::size_t i = 0; i < std::min({names.size(), olds.size(), news.size()}); ++i)
            if (olds[i] != news[i]) ++moved_columns_[names[i]];
    }

    // Of a table the columns that differ, of a text the lines.
    std::string difference(const std::string& old_value, const std::string& new_value) const {
        const char at = kind_ == Kind::table ? ',' : '\n';
        const std::vector<std::string> names = split(columns_, ','), olds = split(old_value, at), news = split(new_value, at);
        std::string text;
        if (kind_ == Kind::table) {
            for (std::size_t i = 0; i < std::max(olds.size(), news.size()); ++i) {
                const std::string was = i < olds.size() ? olds[i] : "nothing", is = i < news.size() ? news[i] : "nothing";
                if (was != is) text += fmt::format("    {:<10} old {:<16}  new {}\n", i < names.size() ? names[i] : "?", was, is);
            }
            return text;
        }
        const auto lines_only_in = [](const std::vector<std::string>& lines, const std::vector<std::string>& others,
                                      const char* sign) {
            std::multiset<std::string> rest(others.begin(), others.end());
            std::string only;
            for (const std::string& line : lines) {
                const auto same = rest.find(line);
                if (same == rest.end()) {
                    only += fmt::format("    {} {}\n", sign, line);
                } else {
                    rest.erase(same);
                }
            }
            return only;
        };
        text = lines_only_in(olds, news, "old") + lines_only_in(news, olds, "new");
        return text.empty() ? "    the same lines in another order\n" : text;
    }

    const std::string mark = "==== ";
    std::filesystem::path path_;
    Kind kind_;
    std::string columns_;
    std::map<std::string, std::string> recorded_;
    int moved_ = 0, new_ = 0;                   // while recording
    std::map<std::string, int> moved_columns_;  // how many of them moved in this column
};

}  // namespace feldspar::golden
