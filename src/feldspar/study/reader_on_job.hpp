// What the readers of studies and calibrations share: a file that names a job and a directory for its results.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "feldspar/job/file_reader.hpp"
#include "feldspar/study/base_job.hpp"

namespace feldspar {

/// To be derived from. Keys: `name`, `results`, `job`, `set`; the last two make the base job, with the settings of a command line
/// over it.
class ReaderOnJob : protected FileReader {
protected:
    ReaderOnJob(const std::string& text, const std::filesystem::path& file, std::initializer_list<std::string_view> known,
                std::initializer_list<std::string_view> required, std::span<const std::string> settings = {})
        : FileReader(parse_toml(text, file.string()), file.string(), known, required), base_(root_, file, settings) {}
    ~ReaderOnJob() = default;

    /// The name of `result` (of the file's stem unless it is given), and the directory of its results, named like it unless that
    /// is given, too.
    template <class Result>
    void read_names(Result& result) const {
        result.name = read_directory_name(root_, "name", variant_stem(result.file.stem().string()));
        result.results = std::filesystem::path("results") / read_directory_name(root_, "results", result.name);
    }

    BaseJob base_;
};

}  // namespace feldspar
