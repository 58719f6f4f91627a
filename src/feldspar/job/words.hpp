// The words of job files for what has no name() where it is defined: outlines, distributions of sizes, details of softening.
#pragma once

#include <array>

#include "feldspar/model/spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

inline constexpr std::array shapes{Shape::rectangle, Shape::disc, Shape::polygon, Shape::half_disc, Shape::ring};
/// In place of a shape: the outline is that of the cells of a file.
inline constexpr const char* shape_from_file = "from-file";
inline constexpr std::array grain_size_kinds{GrainSizeKind::uniform, GrainSizeKind::log_normal, GrainSizeKind::sieve};
inline constexpr std::array shear_measures{ShearMeasure::total, ShearMeasure::beyond_friction};
inline constexpr std::array tension_unloadings{TensionUnloading::elastic, TensionUnloading::secant};

inline const char* name(Shape shape) {
    switch (shape) {
        case Shape::rectangle:
            return "rectangle";
        case Shape::disc:
            return "disc";
        case Shape::polygon:
            return "polygon";
        case Shape::half_disc:
            return "half-disc";
        case Shape::ring:
            return "ring";
    }
    return "?";
}
inline const char* name(GrainSizeKind kind) {
    switch (kind) {
        case GrainSizeKind::uniform:
            return "uniform";
        case GrainSizeKind::log_normal:
            return "log-normal";
        case GrainSizeKind::sieve:
            return "sieve";
    }
    return "?";
}
inline const char* name(ShearMeasure measure) { return measure == ShearMeasure::total ? "total" : "beyond-friction"; }
inline const char* name(TensionUnloading unloading) { return unloading == TensionUnloading::elastic ? "elastic" : "secant"; }

/// The disc of a Brazilian test.
enum class DiscForm { whole, flattened };
inline constexpr std::array disc_forms{DiscForm::whole, DiscForm::flattened};
inline const char* name(DiscForm form) { return form == DiscForm::whole ? "whole" : "flattened"; }

/// What a fixture of a custom test is.
enum class FixtureForm { boundary, plate, roller, jaw, pressure };
inline constexpr std::array fixture_forms{FixtureForm::boundary, FixtureForm::plate, FixtureForm::roller, FixtureForm::jaw,
                                          FixtureForm::pressure};
inline const char* name(FixtureForm form) {
    switch (form) {
        case FixtureForm::boundary:
            return "boundary";
        case FixtureForm::plate:
            return "plate";
        case FixtureForm::roller:
            return "roller";
        case FixtureForm::jaw:
            return "jaw";
        case FixtureForm::pressure:
            return "pressure";
    }
    return "?";
}

/// What a stage of a test is, or a list of stages that is repeated.
enum class StageForm { load, unload, hold, confine, cycle };
inline constexpr std::array stage_forms{StageForm::load, StageForm::unload, StageForm::hold, StageForm::confine,
                                        StageForm::cycle};
inline const char* name(StageForm form) {
    switch (form) {
        case StageForm::load:
            return name(StageKind::load);
        case StageForm::unload:
            return name(StageKind::unload);
        case StageForm::hold:
            return name(StageKind::hold);
        case StageForm::confine:
            return name(StageKind::confine);
        case StageForm::cycle:
            return "cycle";
    }
    return "?";
}

/// What a gauge of a custom test reads.
enum class GaugeForm { extension, strain, displacement, force, mean_stress, mean_strain, hole_stress, energy };
inline constexpr std::array gauge_forms{GaugeForm::extension,   GaugeForm::strain,      GaugeForm::displacement,
                                        GaugeForm::force,       GaugeForm::mean_stress, GaugeForm::mean_strain,
                                        GaugeForm::hole_stress, GaugeForm::energy};
inline const char* name(GaugeForm form) {
    switch (form) {
        case GaugeForm::extension:
            return "extension";
        case GaugeForm::strain:
            return "strain";
        case GaugeForm::displacement:
            return "displacement";
        case GaugeForm::force:
            return "force";
        case GaugeForm::mean_stress:
            return "mean-stress";
        case GaugeForm::mean_strain:
            return "mean-strain";
        case GaugeForm::hole_stress:
            return "hole-stress";
        case GaugeForm::energy:
            return "energy";
    }
    return "?";
}

}  // namespace feldspar
