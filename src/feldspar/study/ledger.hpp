// The ledger of studies: an SQLite file with one row a run. Several programs may work on one ledger at once: a run belongs to
// who claimed it, and goes back to all when that process is no longer there.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/study/run_record.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

class Ledger {
public:
    /// `memory`: no file is read or written, the ledger starts empty and is gone with the object; the runs' directories are on
    /// disk all the same, and what they hold counts. For where a file could not be shared.
    enum class Access { read, write, memory };

    /// Opens `directory`/ledger.sqlite; with write access makes it if it is not there. @throws InputError for a file that is not
    /// a ledger, or that a later version has made; OutputError when it cannot be written, or is damaged (so do all calls that
    /// read).
    /// @param watched  a process of another machine whose sign of life is old is taken for gone only if it gives none for so long
    /// while this object looks
    Ledger(const std::filesystem::path& directory, Access access, std::chrono::milliseconds watched = std::chrono::minutes(1));
    ~Ledger();
    Ledger(Ledger&&) noexcept;

    const std::filesystem::path& directory() const;
    std::filesystem::path run_directory(const std::string& id) const;  ///< `directory`/runs/<id>

    /// Writes down which runs the study consists of, with the labels of their points, so that the ledger can be read without the
    /// study's file; replaces what was there of this study.
    void enrol(const Study& study);

    enum class Claim { ours, done, failed, others };  ///< `others`: another live process is at it

    /// Takes a run for this process unless it is done or another live process has it. A failed run may be taken again, but for
    /// one that failed for good: with this program, or on this object (so that whoever asks for it again gets the same answer).
    /// @param program  whose failures count; none if all may be taken again
    Claim claim(const Run& run, const Provenance* program = nullptr);

    /// Gives a claimed run back as if it had never been taken (interrupted).
    void release(const std::string& id);

    /// Whether a claimed run is still this process's; not if it was silent for so long (asleep) that another has taken it.
    bool holds(const std::string& id) const;

    /// Records the end of a run. Never replaces a run that is done.
    void record(const RunRecord& record);

    /// Says that this process still works on its claims; to be called about every 20 s.
    void heartbeat();

    std::optional<RunRecord> find(const std::string& id) const;
    /// In the order of `ids`; those that the ledger does not have are left out.
    std::vector<RunRecord> find(std::span<const std::string> ids) const;

private:
    struct Database;
    std::unique_ptr<Database> database_;
};

}  // namespace feldspar
