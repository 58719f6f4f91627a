// The strength envelope of a job's rock as one piece of work: which tests it takes, and the files that say what came out.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/findings/envelope_fits.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/point_results.hpp"

namespace feldspar {

struct EnvelopeOptions {
    std::optional<int> seeds;                      ///< packings; default: the job's if it has several, else 5
    std::vector<double> sigma3_Pa;                 ///< of the biaxial tests; default: the job's, else default_series()
    bool with_tension = false;                     ///< Hoek-Brown's parabola through the direct tensile strengths too
    std::optional<std::filesystem::path> results;  ///< default: results/<job>-envelope
};

struct EnvelopePlan {
    Study study;                       ///< a point for each variant of the job
    std::vector<std::string> remarks;  ///< what was added to the job and what could not be, in sentences
};

/// Uniaxial, biaxial, direct tension and Brazilian tests of the job on all packings; tests that the job lacks are added with
/// default settings. @throws InputError for a specimen that platens cannot press
EnvelopePlan plan_envelope(const Job& job, const EnvelopeOptions& options);

/// The uniaxial strength by which confining stresses are chosen: the laboratory's, or from its cohesion and friction angle, else
/// four times the contacts' cohesion tau (the Augig granite's ratio).
double expected_UCS_Pa(const Job& job);

/// 2.5, 5, 10 and 15 % of the expected strength, each rounded to half a unit of its first digit: 3, 6, 10, 20 MPa for 122 MPa.
std::vector<double> default_series(double expected_UCS_Pa);

/// envelope.csv, envelope.json and envelope.html in `directory`, which is there.
void write_envelope(const std::filesystem::path& directory, const Study& study, std::span<const PointResults> points,
                    bool with_tension, const Provenance& provenance);

/// What the command prints. @param columns  of the terminal; 0: of none
std::string envelope_text(const Study& study, std::span<const PointResults> points, bool with_tension, std::size_t columns = 0);

}  // namespace feldspar
