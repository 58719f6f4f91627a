// What is to be calibrated: a laboratory's numbers, and the keys of a job that may be chosen so that the model shows them
// (docs/calibration.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "feldspar/job/first_job.hpp"
#include "feldspar/study/base_job.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

inline constexpr const char* strength_column = "strength_Pa";  ///< of the ledger

/// What is read off one run.
struct Observable {
    std::string name;  ///< "E", "nu", "UCS", "DTS", "BTS", "sigma1 at 10 MPa", ...
    MethodId test;
    double sigma3_Pa = 0.0;   ///< of biaxial tests
    std::string column;       ///< of the ledger
    bool logarithmic = true;  ///< learned as its logarithm; else as it is
};

/// A number that the laboratory has measured: the mean over packings is to show it.
struct Target {
    std::string
        name;  ///< "E", "nu", "UCS", "DTS", "BTS", "UCS_over_BTS", "UCS_over_DTS", "BTS_over_DTS", "cohesion", "friction_angle",
               ///< "hoek_brown_mi", "sigma_ci", "sigma_cd", "sigma_ci_over_UCS", "sigma_cd_over_UCS", "sigma1"
    double sigma3_Pa = 0.0;  ///< of "sigma1"
    double value = 0.0;      ///< SI, degrees
    double tolerance = 0.0;  ///< in the same unit: as good as met within it

    std::string label() const;  ///< "sigma1 at 10 MPa"
};

/// A key of the job that calibration chooses.
struct Unknown {
    std::string name;
    std::string key;
    std::string times;  ///< the value multiplies that of this key; empty if it stands as it is
    std::vector<std::pair<std::string, double>> coupled;
    double low = 0.0, high = 0.0;  ///< in `unit`
    std::string unit;              ///< "GPa/m"; empty for plain numbers
    bool logarithmic = true;
    bool elastic = false;  ///< E and nu follow from these alone: found first, by short tests below the first damage

    double value_at(double x) const;  ///< 0 ... 1 -> low ... high, rounded to six digits so that it reads well
    double x_of(double value) const;
};

struct Calibration {
    std::filesystem::path file;
    std::string text;
    std::string name;
    std::filesystem::path results;
    BaseJob base;
    std::vector<Target> targets;
    std::vector<Unknown> unknowns;
    std::vector<std::uint64_t> seeds;          ///< packings on which it learns
    std::vector<std::uint64_t> confirm_seeds;  ///< packings that it never learns from
    int budget = 300;                          ///< runs, confirmation included
    std::vector<double> sigma3_Pa;             ///< of the biaxial tests from which cohesion, friction angle and mi are read

    /// The job with these values of the unknowns, one each in their order.
    Job job_with(const std::vector<double>& values) const;
};

/// Reads and checks the file. @throws InputError naming file, line, key, value and what is allowed
/// @param settings  "key=value" (job/set_keys.hpp), over the job and `[set]`. A key that is an unknown, or coupled to one, is
/// refused, and so are other tables than specimen, model, material, numerics, test and laboratory
Calibration read_calibration(const std::filesystem::path& file, std::span<const std::string> settings = {});
Calibration parse_calibration(const std::string& text, const std::filesystem::path& name,
                              std::span<const std::string> settings = {});

/// A commented calibration to start from, which reads as it stands beside a job "rock.toml" with a uniaxial, a Brazilian and a
/// biaxial test.
std::string calibration_template();

/// The same with the numbers of this rock as targets.
std::string calibration_template(const ReadRock& rock);

/// What the targets need to be known of runs, each once.
std::vector<Observable> observables_for(const Calibration& calibration);
std::vector<Observable> observables_for(const std::vector<Target>& targets, const std::vector<double>& sigma3_Pa);

/// The property of the rock that a target is a value of, by its name in PropertySummary: "E_Pa", "sigma_ci_crack_volume_Pa", ...
std::string property_of(const Target& target);

/// A target's value by the means of the quantities, in the order of observables_for(); not-a-number where they do not make sense.
double value_of(const Target& target, const std::vector<Observable>& quantities, const std::vector<double>& means);

/// Whether a target's value hangs on that quantity.
bool needs(const Target& target, const std::vector<Observable>& quantities, std::size_t quantity);

/// Of the first target of that name; not-a-number if there is none.
double target_value(std::string_view name, const std::vector<Target>& targets);

/// The uniaxial strength that the targets ask for, by Mohr and Coulomb's line if not by itself; not-a-number if they say nothing
/// of it.
double wanted_UCS_Pa(const std::vector<Target>& targets);

/// The strength that the targets ask a compression test for: UCS, sigma1 itself or by Mohr and Coulomb's line; not-a-number for
/// other tests, and if they say nothing of it.
double wanted_strength_Pa(const TestSpec& test, const std::vector<Target>& targets);

/// Sentences on targets that no rock can show together, by closed form; none if there is nothing to say.
std::vector<std::string> contradictions(const std::vector<Target>& targets);

}  // namespace feldspar
