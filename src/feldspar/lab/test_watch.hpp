// Looking at a test while it runs: what it has so far, from its own thread, between steps.
#pragma once

#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// What there is of a running test at the moment. It holds only during the call in which it is given.
class TestSight {
public:
    virtual ~TestSight() = default;

    /// History and cracks so far. A test that passes its strength again, more slowly, takes back what it had of the passage
    /// before, and counts one passage more.
    virtual const TestResult& so_far() const = 0;

    /// Displacement of each node of the grain mesh now, m; computed by the call.
    virtual std::vector<Vec2> displacements() const = 0;
};

/// Who looks at a running test. All calls come on the test's thread. What it does changes nothing of the test, but ended() ends
/// it.
class TestWatch {
public:
    virtual ~TestWatch() = default;

    /// Whether it wants to see the test now; asked at every record, so it should only look whether something is wanted.
    virtual bool due() = 0;

    /// What there is so far.
    virtual void see(const TestSight& sight) = 0;

    /// Whether the user has ended this test: it then ends at its record as by a stop rule, with the numbers that its record
    /// shows, and is not repeated.
    virtual bool ended() const = 0;
};

/// Why such a test ended, for TestResult::stop_reason.
inline constexpr const char* kEndedByUser = "ended by the user";

}  // namespace feldspar
