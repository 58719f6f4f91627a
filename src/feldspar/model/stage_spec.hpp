// Stages of a test, as plain data: what the loading motion does one after the other, and when it goes on to the next. A test
// without stages is one stage that loads until the test's stop rule ends it (docs/theory/loading.md, section 7).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace feldspar {

enum class StageKind {
    load,    ///< the loading motion grows
    unload,  ///< the loading motion goes back
    hold,    ///< the loading motion is at rest
    confine  ///< pressures go to another value
};

/// What ends a stage of loading or unloading.
enum class StageEnd {
    test,            ///< nothing but the stop rule of the test: the last stage
    stress,          ///< the stress reaches a value, Pa, positive in the sense of the loading
    load,            ///< the load reaches a value, N, likewise
    axial_strain,    ///< loading motion over length, a pure number, positive in the sense of the loading
    lateral_strain,  ///< that of the gauge in the middle, < 0 when the specimen widens
    gauge,           ///< a gauge of the test, SI
    share_of_peak,   ///< the load has fallen to a share of its largest value so far
    reversal         ///< the volumetric strain of the stage has turned: the specimen dilates
};

/// From where the value of an end counts.
enum class StageValue {
    reached,  ///< the quantity itself
    changed,  ///< its change since the stage began, > 0
    beyond    ///< how far it goes beyond where the last loading ended, > 0; in the first loading its change
};

/// What a stage of confining does with the loading motion.
enum class ConfineKeep {
    motion,  ///< it is at rest
    load     ///< it follows, so that the axial stress stays as it is
};

/// One stage.
struct StageSpec {
    StageKind kind = StageKind::load;
    StageEnd end = StageEnd::test;  ///< load and unload
    double value = 0.0;             ///< of the end, SI
    StageValue counts = StageValue::reached;
    std::string gauge{};                     ///< StageEnd::gauge
    std::optional<double> travel_times{};    ///< hold: how long, in travel times of a wave; none: until the specimen is quiet
    double sigma3_Pa = 0.0;                  ///< confine: the pressure at the end, 0 or more
    std::string fixture{};                   ///< confine: whose pressure; empty: all of the test
    ConfineKeep keep = ConfineKeep::motion;  ///< confine

    bool operator==(const StageSpec&) const = default;
};

/// Stages that are repeated as a whole.
struct StageGroup {
    std::vector<StageSpec> stages;  ///< at least one
    int times = 1;                  ///< 0: until the stop rule of the test ends it

    bool operator==(const StageGroup&) const = default;
};

inline constexpr std::array stage_kinds{StageKind::load, StageKind::unload, StageKind::hold, StageKind::confine};
inline constexpr std::array stage_ends{StageEnd::stress,        StageEnd::load,
                                       StageEnd::axial_strain,  StageEnd::lateral_strain,
                                       StageEnd::share_of_peak, StageEnd::reversal};  // and gauges, by their names
inline constexpr std::array confine_keeps{ConfineKeep::motion, ConfineKeep::load};

inline const char* name(StageKind kind) {
    switch (kind) {
        case StageKind::load:
            return "load";
        case StageKind::unload:
            return "unload";
        case StageKind::hold:
            return "hold";
        case StageKind::confine:
            return "confine";
    }
    return "?";
}
inline const char* name(StageEnd end) {
    switch (end) {
        case StageEnd::test:
            return "test";
        case StageEnd::stress:
            return "stress";
        case StageEnd::load:
            return "load";
        case StageEnd::axial_strain:
            return "axial-strain";
        case StageEnd::lateral_strain:
            return "lateral-strain";
        case StageEnd::gauge:
            return "gauge";
        case StageEnd::share_of_peak:
            return "share-of-peak";
        case StageEnd::reversal:
            return "reversal";
    }
    return "?";
}
inline const char* name(ConfineKeep keep) { return keep == ConfineKeep::motion ? "motion" : "load"; }

}  // namespace feldspar
