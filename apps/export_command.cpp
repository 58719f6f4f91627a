#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "commands.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/test_fields.hpp"
#include "interrupt.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

// The archives of a run, or the one that is named, by their stems.
std::map<std::string, fs::path> archives_in(const fs::path& run) {
    std::error_code error;
    if (fs::is_regular_file(run, error)) return {{run.stem().string(), run}};
    if (!fs::is_directory(run, error))
        throw InputError({{}, 0, 0, "RUN"}, fmt::format("'{}' is neither a directory nor a file", run.string()),
                         "the directory of a run, such as results/granite-1, or one of its .h5 files");
    std::map<std::string, fs::path> archives;
    for (fs::directory_iterator entry(run, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".h5") archives[entry->path().stem().string()] = entry->path();
    if (error) throw InputError({{}, 0, 0, "RUN"}, fmt::format("'{}' cannot be read: {}", run.string(), error.message()));
    if (archives.empty())
        throw InputError({{}, 0, 0, "RUN"},
                         fmt::format("there is no .h5 file in '{}', so there are no fields to export", run.string()),
                         "the directory of a run that kept its fields", "--keep all, the default of 'feldspar run', keeps them");
    return archives;
}

// Leaves the tests that the command line names, by their stems or the kinds with which these begin.
void keep_named(std::map<std::string, fs::path>& archives, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    const auto is = [](const std::string& stem, const std::string& word) {
        return stem == word || stem.starts_with(word + "-s") || stem.find("-" + word + "-s") != std::string::npos;
    };
    std::vector<std::string_view> stems;
    for (const auto& [stem, file] : archives) stems.push_back(stem);
    for (const std::string& word : wanted)
        if (std::ranges::none_of(archives, [&](const auto& archive) { return is(archive.first, word); }))
            throw InputError({{}, 0, 0, "--test"}, fmt::format("the run has no archive of '{}'", word), listed(stems),
                             did_you_mean(word, stems));
    std::erase_if(archives, [&](const auto& archive) {
        return std::ranges::none_of(wanted, [&](const std::string& word) { return is(archive.first, word); });
    });
}

}  // namespace

ExitCode export_command(const ExportOptions& options) {
    install_signal_handlers();
    if (!options.vtu)
        throw InputError({{}, 0, 0, "export"}, "no format is named", "--vtu (ParaView and other programs that read VTK)");
    const fs::path run = options.run;
    std::map<std::string, fs::path> archives = archives_in(run);
    keep_named(archives, full_kinds(options.tests));
    std::error_code error;
    const fs::path folder =
        options.out ? fs::path(*options.out) : (fs::is_directory(run, error) ? run : run.parent_path()) / "paraview";
    fs::create_directories(folder, error);
    if (error)
        throw InputError({{}, 0, 0, "--out"}, fmt::format("'{}' cannot be made: {}", folder.string(), error.message()),
                         "a directory that can be written to");
    const RunDirectory directory = RunDirectory::open(folder);
    const int threads = thread_count(options.threads.value_or(0));
    for (const auto& [stem, file] : archives) {
        if (stop_requested()) throw Interrupted();
        const fs::path collection = folder / (stem + ".pvd");
        const bool again = fs::exists(collection, error);
        const TestFields fields = read_archive(file);
        if (fields.nodes.empty()) {
            say(stderr, "warning: '{}' holds no mesh, so nothing is written of it\n", file.string());
            continue;
        }
        write_paraview(directory, fields, threads);
        say("{}: {}{}\n", collection.string(), counted(fields.snapshots.size(), "moment"),
            again ? ", in place of those of an earlier export" : "");
    }
    say(stderr, "paraview --script={} opens a test coloured\n", (folder / (archives.begin()->first + ".py")).string());
    return ExitCode::success;
}

}  // namespace feldspar
