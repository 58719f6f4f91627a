// Who watches a test while it runs, and may lead it: between blocks of steps the observer sees the state, and orders what the
// loading does from then on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/model/stage_spec.hpp"

namespace feldspar {

struct Assembly;

/// What an observer sees: the state that the last step left, with the signs of the inside (tension positive) where the row of the
/// history does not say otherwise. Valid during the call only.
struct TestView {
    const TestResult& result;                ///< so far; the row of the present state is its history's last one
    const Assembly& assembly;                ///< nodes, bonds, contacts, fixtures
    const std::vector<GaugeSpec>& gauges;    ///< whose readings the rows have
    double travel_m = 0.0;                   ///< loading motion since the start
    double speed = 0.0;                      ///< of the loading motion, m a step (dynamic: m/s)
    double time_step = 1.0;                  ///< 1, or s with real masses
    double travel_time = 0.0;                ///< of a wave over the length, units of the time step
    int stage = 0;                           ///< number of the stage under way, from 1; 0 without stages
    StageKind kind = StageKind::load;        ///< of the stage under way
    std::optional<std::string> stage_ended;  ///< why the stage under way has come to its end at this row; empty while it has not
    int passage = 1;  ///< of the strength: in another one the test has gone back, and the step is smaller than before

    const HistoryRow& row() const { return result.history.back(); }
};

/// What an observer wants. Nothing: the test goes on as it would without it.
struct TestOrders {
    struct Pressure {
        std::string fixture;       ///< that has a pressure; empty: all of them
        double pressure_Pa = 0.0;  ///< 0 or more
    };
    struct Motion {
        std::string fixture;  ///< that imposes a motion or is at rest; no membrane
        Vec2 motion{};        ///< per unit of the loading motion
    };
    enum class Pace { as_before, given, own };

    std::optional<std::string> stop{};  ///< the test ends here, for this reason
    std::optional<StageSpec>
        stage{};  ///< begins at this row in place of the one under way and of all that were to follow it; tests with stages only
    Pace pace = Pace::as_before;  ///< given: the loading motion has `speed` from now on; own: the speed is again the test's own
                                  ///< choice. A stage that begins has its own
    double speed = 0.0;           ///< m a step (dynamic: m/s); negative goes back
    std::vector<Pressure> pressures{};  ///< that hold from the next step on, at once; a stage that confines changes them slowly
    std::vector<Motion> motions{};      ///< of fixtures, from the next step on
};

/// Looks at a test at every record of its loading: every 10 steps with adaptive numerics, every 50 with others.
///
/// With adaptive numerics a test may go back and pass its strength again, more slowly: the observer then sees earlier steps
/// again, so what it orders should follow from what it sees, not from how often it was asked. A test that an observer leads is
/// kept nowhere (RunControl::keeper is not asked), for what the observer knows is not the test's.
class TestObserver {
public:
    virtual ~TestObserver() = default;

    /// The stage with which the loading begins, if the observer is to lead the test by stages: the test is then one with stages,
    /// of which this is the first and, until another is ordered, the last. Asked once, before anything else. Nothing: the test
    /// has the stages of its setup, or none.
    virtual std::optional<StageSpec> begins() { return std::nullopt; }

    /// @return what is to change. @throws what it likes: the test ends with that
    virtual TestOrders look(const TestView& view) = 0;

    /// Given the body when its test is over, in whatever way: for those who still look at its arrays. Must not throw.
    virtual void leaves(Assembly&& assembly) noexcept { (void)assembly; }
};

}  // namespace feldspar
