// Does the answer depend on how it was computed? One thing at a time is varied about a job: grain size, specimen size, triangles
// a grain, loading rate; the number of packings is judged by subsets of them (docs/study.md, Convergence).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "feldspar/findings/comparison.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {

struct ConvergeOptions {
    std::optional<int> seeds;                      ///< packings; default: the job's if it has several, else 3
    std::vector<std::string> tests;                ///< kinds; default: the job's uniaxial, direct tension and Brazilian tests
    double within = 0.05;                          ///< a change that does not matter, relative
    std::optional<std::filesystem::path> results;  ///< default: results/<job>-converge
};

/// One thing that is varied, all others being the job's.
struct ConvergeAxis {
    std::string name;                 ///< "grain size"
    std::string unit;                 ///< of the numbers: "mm"; empty for a ratio
    bool same_packings = false;       ///< a packing is the same at all values, so that changes are formed on each packing
    std::vector<std::size_t> points;  ///< of the study, by growing value
    std::size_t base = 0;             ///< which of them is the job as it is
};

struct ConvergePlan {
    Study study;  ///< its first point is the job as it is
    std::vector<ConvergeAxis> axes;
    std::vector<std::string> remarks;  ///< what was left out and why, and what is doubtful, in sentences
    double within = 0.05;
};

/// @throws InputError for a job with several variants, or without a test that can be compared
ConvergePlan plan_convergence(const Job& job, const ConvergeOptions& options);

enum class Dependence { independent, undecided, depends };

const char* name(Dependence dependence);

struct Finding {
    Dependence dependence = Dependence::undecided;
    std::string words;   ///< without the property: "independent within 1.8 %"
    double bound = 0.0;  ///< the largest relative change that is not ruled out; not-a-number without an interval
    int packings = 0;    ///< undecided: about so many would decide; 0 if this cannot be said
};

/// A property at one value of an axis.
struct ValueAt {
    std::string label;
    double number = 0.0;  ///< not-a-number for a word
    MeanInterval mean;    ///< SI, degrees
    Change change;        ///< against the base; of the base itself nothing
};

/// A property along an axis.
struct PropertyAlong {
    std::string property;
    std::vector<ValueAt> values;
    std::size_t base = 0;  ///< of values
    Finding verdict;
};

struct AxisResult {
    ConvergeAxis axis;
    std::vector<PropertyAlong> properties;
    Finding verdict;  ///< of all properties
};

/// A property by the number of packings, at the base.
struct SeedResult {
    std::string property;
    MeanInterval mean;
    std::vector<Subsample> subsamples;
    Finding verdict;
};

struct Convergence {
    std::vector<AxisResult> axes;
    std::vector<SeedResult> seeds;
    Finding seed_verdict;
    std::string overall;  ///< in sentences
};

Convergence judge_convergence(const ConvergePlan& plan, std::span<const PointResults> points);

/// One property: `stands` says which changes stand beside all others of the axis (stand_together); the base's is not read.
Finding judge_property(const PropertyAlong& along, const std::vector<bool>& stands, double within);

/// Whether enough packings were taken for +- `within` of the mean.
Finding judge_packings(const MeanInterval& mean, double within);

/// converge.csv, converge.json and converge.html in `directory`, which is there.
void write_convergence(const std::filesystem::path& directory, const ConvergePlan& plan, std::span<const PointResults> points,
                       const Provenance& provenance);

/// What the command prints. @param columns  of the terminal; 0: of none
std::string convergence_text(const ConvergePlan& plan, std::span<const PointResults> points, std::size_t columns = 0);

}  // namespace feldspar
