// What is going on in a run, for those who look at it while it runs: plain data that the run puts here and that pages take from
// here (live_stream.hpp).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/lab/run_test.hpp"
#include "feldspar/lab/test_watch.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// A test that is to be run.
struct LivePlan {
    std::string label;        ///< "biaxial at 4 MPa, seed 1"
    std::string kind;         ///< tests of one kind take about equally long: "biaxial at 4 MPa"
    std::string stress_axis;  ///< what stands at the axes of its curve, without units
    std::string strain_axis;
};

/// What the page calls things, and what becomes of a test that the user ends.
struct LiveWords {
    std::string whole = "run";  ///< "study", "calibration"
    std::string one = "test";   ///< "run"
    bool keeps_ended = true;    ///< a test that the user ends keeps its results; else it has none, and is made again another time
};

enum class LiveState { waiting, running, writing, ended, failed };

/// A point of a curve, as it is shown.
struct LivePoint {
    float strain = 0.0F;  ///< 10^-3, compression positive
    float stress = 0.0F;  ///< MPa
    int tensile = 0;      ///< cracks until then
    int shear = 0;
};

struct LiveCrack {
    float x0 = 0.0F, y0 = 0.0F, x1 = 0.0F, y1 = 0.0F;  ///< its ends, mm, undeformed
    std::uint8_t mode = 0;                             ///< 0 tensile, 1 shear
    int grain_a = 0, grain_b = 0;                      ///< between which it is
};

/// Displacements of the corners of all grains, grain by grain: all x, then all y.
struct LiveFrame {
    std::vector<std::int16_t> steps;
    double scale_mm = 1.0;  ///< of a step
};

/// What is to be said of a test that has ended.
struct LiveResult {
    LiveState state = LiveState::ended;
    std::string words;    ///< "114 MPa, grade B", or why it failed
    double took_s = 0.0;  ///< of one that was not made here; 0: as long as it was running here
};

/// The places of all calls: the run's on its own thread, but a test's watch on the test's; the pages' on any. Whoever looks costs
/// the tests nothing but what they are asked for at most a few times a second: that takes at most a hundredth of their time.
class LiveBoard {
public:
    /// @param name  of the run   @param stop  is set when the user ends the run
    LiveBoard(std::string name, std::atomic<bool>& stop, LiveWords words = {});
    ~LiveBoard();
    LiveBoard(const LiveBoard&) = delete;
    LiveBoard& operator=(const LiveBoard&) = delete;

    // The run's side.

    void planned(std::vector<LivePlan> tests);
    /// One more test, of which nobody knew before. @return its number
    std::size_t adds(LivePlan test);
    /// Tests become known on the way; there will be at most so many.
    void expects(std::size_t most);
    /// What is being done now that is no test.
    void busy(const std::string& what);
    /// Test number `test` (from 0 on) begins on this specimen. @return who looks at it; it stays as long as the board
    TestWatch& begins(std::size_t test, std::shared_ptr<const Specimen> specimen);
    /// The same for a run of which only the progress is shown.
    void begins(std::size_t test);
    void progress(std::size_t test, const TestProgress& state);
    /// It has ended without a result and waits again.
    void waits(std::size_t test);
    /// It no longer runs, and its files are being written.
    void written(std::size_t test);
    void ended(std::size_t test, const LiveResult& result);
    /// The report in this file has been written, or written again.
    void report(const std::filesystem::path& file);
    /// The run is over. @param words  how, for the user
    void over(const std::string& words);

    // The side of those who look.

    const std::string& name() const { return name_; }
    const LiveWords& words() const { return words_; }
    std::filesystem::path report_file() const;
    bool is_over() const;
    std::string over_words() const;
    /// Someone begins, or ceases, to look.
    void looked_at(bool begins);
    bool is_looked_at() const { return watchers_.load() > 0; }
    /// Asks the tests that run to show themselves, those that may be asked again.
    void ask_tests();
    /// The user ends a test. @return whether it runs
    bool end_test(std::size_t test);
    /// The user ends the run, as by Ctrl-C.
    void end_run();
    /// Waits for news since `version`, at most so long. @return the version now
    std::uint64_t wait(std::uint64_t version, std::chrono::milliseconds at_most);
    /// Share of the tests' time that showing has taken, of those that were looked at. 0 where none was.
    double cost() const;

private:
    friend class LiveStream;
    class Watch;
    struct Test;
    void news();  // with the lock
    double seconds_left() const;

    const std::string name_;
    const LiveWords words_;
    std::atomic<bool>& stop_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t version_ = 1;
    std::vector<std::unique_ptr<Test>> tests_;
    std::size_t most_ = 0;  // tests that there will be; 0: those that are known
    std::string busy_;
    std::filesystem::path report_;
    int reports_ = 0;  // how often it was written
    bool over_ = false;
    std::string over_words_;
    bool ending_ = false;  // by the user
    std::atomic<int> watchers_{0};
};

}  // namespace feldspar
