// What readers of files share, be it a job, a study or a calibration: the parsed tree, and a checked view of the file's own
// table.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "feldspar/job/toml_reader.hpp"

namespace feldspar {

/// To be derived from by the reader of one kind of file. Mistakes are collected: the reader calls finish() at the end, and
/// returns nothing before.
class FileReader {
public:
    FileReader(const FileReader&) = delete;  // root_ looks into tree_ and mistakes_
    FileReader& operator=(const FileReader&) = delete;

protected:
    /// @param file      stands for the file in messages
    /// @param known     all keys and tables that the file may have; @param required  those that it must have
    FileReader(toml::table tree, std::string file, std::span<const std::string_view> known,
               std::initializer_list<std::string_view> required, int level = 0)
        : tree_(std::move(tree)), mistakes_(file), root_(tree_, "", std::move(file), known, level, &mistakes_) {
        root_.require(required);
    }
    FileReader(toml::table tree, std::string file, std::initializer_list<std::string_view> known,
               std::initializer_list<std::string_view> required, int level = 0)
        : FileReader(std::move(tree), std::move(file), std::span(known.begin(), known.size()), required, level) {}
    ~FileReader() = default;

    /// @throws InputError for one mistake, InputErrors for several
    void finish() const { mistakes_.throw_if_any(); }

    toml::table tree_;
    Mistakes mistakes_;
    TableReader root_;
};

}  // namespace feldspar
