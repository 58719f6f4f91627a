// What the board holds of one test. Internal to this room.
#pragma once

#include "feldspar/live/live_board.hpp"

namespace feldspar {

inline constexpr std::size_t kMostShownGrains = 40'000;  ///< of a specimen with more there is only the curve

/// Looks at a running test when it is asked to, and leaves on the board what is new.
class LiveBoard::Watch final : public TestWatch {
public:
    using Clock = std::chrono::steady_clock;

    Watch(LiveBoard& board, Test& test) : board_(board), test_(test) {}

    bool due() override { return wanted_.load(std::memory_order_relaxed); }
    bool ended() const override { return ended_.load(std::memory_order_relaxed); }
    void see(const TestSight& sight) override;

    void end() { ended_ = true; }
    /// Asks for a look, unless the last one is too short ago.
    void ask(Clock::time_point now) {
        if (now.time_since_epoch().count() >= not_before_.load()) wanted_ = true;
    }
    /// Seconds that looks have taken, and that passed since the first one.
    double taken_s() const { return taken_s_.load(); }
    double passed_s() const { return passed_s_.load(); }

private:
    void add_frame(const TestSight& sight, Clock::time_point now);

    LiveBoard& board_;
    Test& test_;
    std::atomic<bool> wanted_{false}, ended_{false};
    std::atomic<Clock::rep> not_before_{0};
    std::atomic<double> taken_s_{0.0}, passed_s_{0.0};
    // Of the test's thread alone:
    const TestResult* of_ = nullptr;     // whose record it was: a test may be repeated
    std::size_t rows_ = 0, cracks_ = 0;  // seen
    int passages_ = 1;
    std::optional<Clock::time_point> first_;
    Clock::time_point next_frame_{};
};

/// All but the plan is guarded by the board's mutex.
struct LiveBoard::Test {
    LivePlan plan;
    LiveState state = LiveState::waiting;
    std::string words;
    std::optional<TestProgress> progress;
    std::chrono::steady_clock::time_point began;
    double took_s = 0.0;
    std::uint64_t version = 0;             // of the board at its last change
    int curve_round = 0, crack_round = 0;  // grow when what was shown holds no longer
    std::vector<LivePoint> curve;
    std::vector<LiveCrack> cracks;
    std::shared_ptr<const Specimen> specimen;  // while it runs
    std::shared_ptr<const LiveFrame> frame;    // the last one
    std::unique_ptr<Watch> watch;

    /// What is shown of a running one.
    void forget() {
        progress.reset();
        curve = {};
        cracks = {};
        ++curve_round;
        ++crack_round;
        frame.reset();
        specimen.reset();
    }
};

}  // namespace feldspar
