#include "feldspar/study/job_place.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/study/planned_runs.hpp"
#include "feldspar/study/study.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

const fs::path kJobFile = "job", kLockFile = "lock";

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool is_unfinished(const fs::path& directory) {
    std::error_code error;
    return fs::exists(directory / kCheckpoints / kJobFile, error);
}

// Made by a program that was ended before it had written anything.
bool is_untouched(const fs::path& directory) {
    std::error_code error;
    if (!fs::is_directory(directory / kCheckpoints, error)) return false;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, error))
        if (entry.path().filename() != kCheckpoints) return false;
    return !error;
}

}  // namespace

std::optional<FileLock> FileLock::take(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) throw OutputError(fmt::format("cannot write '{}': {}", file.string(), std::strerror(errno)));
    FileLock lock(descriptor);
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return lock;  // a file system without locks keeps nobody out
    return std::nullopt;
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::string identity_of_job(const Job& job) {
    Job same = job;
    same.threads = same.at_once = 0;
    std::string text = resolved_toml(same);
    for (const PlannedRun& run : planned_runs(job)) text += make_run(job, *run.variant, *run.test, run.seed).id;
    return hash_of_text(text);
}

FoundPlace find_place(const std::optional<fs::path>& wanted, const Job& job, bool fresh) {
    const auto same_job = [&](const fs::path& directory) {
        return text_of(directory / kCheckpoints / kJobFile) == identity_of_job(job);
    };
    if (wanted) {
        const bool untouched = !is_unfinished(*wanted);
        if (untouched && !is_untouched(*wanted)) return {};  // RunDirectory says whether it may be made
        const auto refuse = [&](const std::string& problem, const std::string& allowed) {
            throw InputError({.file = "", .line = 0, .column = 0, .key = "--out"},
                             fmt::format("'{}' {}", wanted->string(), problem), allowed);
        };
        if (fresh) refuse("holds an unfinished run, and results are never overwritten", "another directory with --fresh");
        if (!untouched && !same_job(*wanted))
            refuse("holds an unfinished run of another job",
                   "the job that it was begun with (job.toml there), or another directory");
        std::optional<FileLock> lock = FileLock::take(*wanted / kCheckpoints / kLockFile);
        if (!lock) refuse("is where another program runs this job now", "to wait for it, or another directory");
        return {*wanted, std::move(lock)};
    }
    if (fresh) return {};
    const std::optional<fs::path> newest = RunDirectory::newest(job.name);
    if (!newest || !is_unfinished(*newest) || !same_job(*newest)) return {};
    std::optional<FileLock> lock = FileLock::take(*newest / kCheckpoints / kLockFile);
    if (!lock) return {};
    return {*newest, std::move(lock)};
}

FileLock begin_unfinished(const RunDirectory& directory, const Job& job) try {
    const fs::path folder = directory.path() / kCheckpoints;
    std::error_code error;
    fs::create_directory(folder, error);
    if (error) throw OutputError(fmt::format("cannot make the directory '{}': {}", folder.string(), error.message()));
    std::optional<FileLock> lock = FileLock::take(folder / kLockFile);
    if (!lock)
        throw OutputError(fmt::format("another program has taken '{}'", directory.path().string()));  // it was made a moment ago
    mark_unfinished(directory, job);
    return std::move(*lock);
} catch (const OutputError&) {
    std::error_code ignored;
    fs::remove(directory.path(),
               ignored);  // if it is empty: nothing could be begun in it, and the same command would find it in its way
    throw;
}

void mark_unfinished(const RunDirectory& directory, const Job& job) {
    directory.write_text(fmt::format("{}/{}", kCheckpoints, kJobFile.string()), identity_of_job(job));
}

void end_unfinished(const fs::path& directory) {
    std::error_code ignored;
    fs::remove(directory / kCheckpoints / kJobFile, ignored);  // first: without it the run is complete
    fs::remove_all(directory / kCheckpoints, ignored);
}

}  // namespace feldspar
