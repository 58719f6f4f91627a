// States of running tests on disk, so that a test goes on where it was after the program was ended (docs/reliability.md).
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

/// When states are kept.
struct CheckpointSettings {
    double every_s = 300.0;  ///< wall time between two states of a test, > 0; infinite: only when the program is asked to end, or
                             ///< to keep states
    const std::atomic<unsigned>* wanted = nullptr;  ///< grows when the user asks for states now; may be null
};

/// What a state belongs to. One of another test is never taken; one of another program, or of other kernels, would not leave the
/// same bits.
struct CheckpointOwner {
    std::string test;     ///< an identity: everything that can change the test's result
    std::string version;  ///< of the program, and its commit
    std::string kernels;  ///< by which the packs step: "avx512"; "card": a graphics card makes the steps

    static CheckpointOwner of(const std::string& test, const Provenance& provenance);
    bool operator==(const CheckpointOwner&) const = default;
};

/// Writes a state, or what a finished test leaves: whole or not at all. The one before stays as `name`.before. @throws
/// OutputError
void write_checkpoint(const RunDirectory& directory, const std::string& name, const CheckpointOwner& owner,
                      const std::function<void(const StatePut&)>& write);

/// A file that write_checkpoint() has written.
struct Checkpoint {
    std::vector<char> state;  ///< empty if there is none, or none that can be used
    std::string refused;      ///< why a file that is there was not used; empty otherwise
};

/// The newest whole one of this owner. @param directory  of the run
Checkpoint read_checkpoint(const std::filesystem::path& directory, const std::string& name, const CheckpointOwner& owner);

/// Removes the files of write_checkpoint(), if they are there.
void remove_checkpoint(const std::filesystem::path& directory, const std::string& name);

/// Keeps the states of one test in `directory` under `name`.
class TestCheckpoints final : public StateKeeper {
public:
    /// @param note  told what the user should read; called on the test's own thread; may be empty
    TestCheckpoints(RunDirectory directory, std::string name, CheckpointOwner owner, const CheckpointSettings& settings,
                    std::function<void(const std::string&)> note);

    bool due(bool stopped) override;
    void keep(const std::function<void(const StatePut&)>& write) override;
    std::vector<char> kept() override;
    void refuse(const std::string& reason) override;

private:
    using Clock = std::chrono::steady_clock;
    void tell(const std::string& line) const {
        if (note_) note_(line);
    }

    RunDirectory directory_;
    std::string name_;
    CheckpointOwner owner_;
    CheckpointSettings settings_;
    std::function<void(const std::string&)> note_;
    Clock::time_point kept_at_ = Clock::now();
    unsigned wanted_ = 0;
    bool told_of_failure_ = false;
};

}  // namespace feldspar
