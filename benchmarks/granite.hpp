// The specimens that are measured, and how a stage of their step is run. The only part of the benchmarks that knows the arrays of
// the simulation: when these change, granite.cpp follows, and nothing else.
#pragma once

#include <filesystem>
#include <memory>

#include "benchmarks/cases.hpp"
#include "benchmarks/reading.hpp"
#include "feldspar/base/parallel.hpp"

namespace feldspar {
struct Assembly;
struct StepSettings;
}  // namespace feldspar

namespace feldspar::benchmarks {

/// A specimen of the Augig granite (elastic constants of Table 1, strengths of Table 7 of the paper) between platens or plates,
/// with scaled masses, under a compression of 1e-4.
class Granite {
public:
    /// @param length_scale  over the paper's specimens; the grains keep their size
    /// @param packings      folder in which packings are kept for the next run; empty: none is kept
    Granite(GrainKind grains, Load load, double length_scale, const std::filesystem::path& packings);
    ~Granite();

    /// Puts bonds and damping into this state, whatever they were in before.
    void set(State state);

    /// Runs a stage so many times on all threads of the team. The time step is so short that nothing moves: every step does its
    /// whole work, and the same work.
    void run(Stage stage, Team& team, int steps);

    Counts counts() const;

    /// For whoever makes the steps otherwise (card_benchmark).
    Assembly& assembly();
    const StepSettings& settings() const;

    /// Contact points with damage between 0 and 1, and with damage 1.
    struct Damage {
        long long softened = 0;
        long long broken = 0;
    };
    Damage damage() const;

    /// Whether all node forces of the last step are numbers, and some are not zero.
    bool forces_are_sound() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace feldspar::benchmarks
