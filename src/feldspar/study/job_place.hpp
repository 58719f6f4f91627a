// Where the results of a job go, and whether a run of the same job was ended there before it was complete.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "feldspar/job/job.hpp"
#include "feldspar/output/checkpoints.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

/// A lock on a file that the system gives back when the program ends, however it ends.
class FileLock {
public:
    /// @return nothing if another program has it. @throws OutputError if the file cannot be made
    static std::optional<FileLock> take(const std::filesystem::path& file);
    FileLock(FileLock&& other) noexcept;
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    ~FileLock();

private:
    explicit FileLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

/// What a run of a job finds before it starts.
struct FoundPlace {
    std::optional<std::filesystem::path>
        unfinished;                ///< the directory of a run of the same job that was ended; none: a new one is to be made
    std::optional<FileLock> lock;  ///< on it
};

/// The same for all runs of a job with these results, whatever the number of threads; reads the files that the job names.
std::string identity_of_job(const Job& job);

/// Looks, and makes nothing. @param wanted  the directory that the user names; else the newest of results/<job>-<n>
/// @param fresh  no unfinished run is gone on with. @throws InputError if results cannot go to `wanted`: there is something else,
/// or another program runs there
FoundPlace find_place(const std::optional<std::filesystem::path>& wanted, const Job& job, bool fresh);

/// The directory in which an unfinished run keeps its states.
inline const char* const kCheckpoints = "checkpoints";

/// Marks a new directory as that of an unfinished run of this job. @return the lock on it
FileLock begin_unfinished(const RunDirectory& directory, const Job& job);

/// The same of one that is gone on with.
void mark_unfinished(const RunDirectory& directory, const Job& job);

/// The run is complete: nothing of it is kept any more but its results.
void end_unfinished(const std::filesystem::path& directory);

}  // namespace feldspar
