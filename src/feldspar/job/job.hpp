// A job file, read and checked: every key known, every unit converted once, every impossible value refused.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// One way to model the rock; all variants of a job share its packings and its tests.
struct Variant {
    std::string name;  ///< empty if the job has no [[variant]]
    std::string stem;  ///< the name as the beginning of file names
    ModelSpec model;
    GrainMaterial grain;
    ContactMaterial contact;
    Heterogeneity rock;  ///< what of grains and contacts differs from these; of minerals `grain` is the mean
    NumericsSpec numerics;
    std::vector<std::uint64_t> seeds;  ///< of the job's; empty = all
    std::vector<MethodId> tests;       ///< of the job's; empty = all

    bool runs(MethodId kind) const { return tests.empty() || std::find(tests.begin(), tests.end(), kind) != tests.end(); }
    bool runs(const TestSpec& test, std::uint64_t seed) const {
        return runs(test.kind) && (seeds.empty() || std::find(seeds.begin(), seeds.end(), seed) != seeds.end());
    }
};

/// A strength that the laboratory measured under confinement, compression positive.
struct ConfinedStrength {
    double sigma3_Pa = 0.0;
    double sigma1_Pa = 0.0;
};

/// A value as the user has written it: "25.8 GPa", behind the key "E" of whichever table.
struct WrittenText {
    std::string key, text;
};

/// A whole job, in SI.
struct Job {
    std::filesystem::path file;  ///< as given
    std::string name;            ///< from the key `name`, else the file's stem
    std::string text;  ///< the file as it was read, for provenance; behind it, as comments, what was set beside the file
    std::vector<WrittenText> written;   ///< texts with digits, in the file's order
    SpecimenSpec specimen;              ///< of all tests that have none of their own
    std::vector<Variant> variants{{}};  ///< at least one; a single one without a name if the job has no [[variant]]
    std::vector<TestSpec> tests;
    std::vector<std::uint64_t> seeds;
    int threads = 0;                           ///< of the whole program; 0 = as many as there are cores for it
    int at_once = 0;                           ///< at most so many tests side by side; 0 = as suits their size
    std::map<std::string, double> laboratory;  ///< SI (radians for angles), by the names of `summary.json`: E, nu, UCS, DTS, BTS,
                                               ///< cohesion, friction_angle, hoek_brown_mi
    std::vector<ConfinedStrength> laboratory_confined;  ///< in the order of the job

    bool has_variants() const { return variants.size() > 1 || !variants.front().name.empty(); }
};

/// A variant's name as the beginning of a file name: "Rigid, brittle" -> "rigid-brittle".
std::string variant_stem(const std::string& name);

/// Reads and checks a job file. @param settings  "key=value" laid over it (set_keys.hpp). @throws InputError naming file, line,
/// column, key, value and what is allowed.
Job read_job(const std::filesystem::path& file, std::span<const std::string> settings = {});

/// The same from text (standard input, tests and the `new` command); `name` stands in for the file in messages.
Job parse_job(const std::string& text, const std::string& name, std::span<const std::string> settings = {});

/// Reads the table [specimen] of such a text alone, whatever else stands in it: a specimen without a test. @throws InputError
/// likewise
SpecimenSpec parse_specimen(const std::string& text, const std::string& name);

/// Sentences on what is allowed but may not be what was meant; none if there is nothing to say.
std::vector<std::string> warnings(const Job& job);

/// The specimen of a test of the job: its own, else the job's.
inline const SpecimenSpec& specimen_of(const Job& job, const TestSpec& test) {
    return test.specimen ? *test.specimen : job.specimen;
}

/// The grains of a specimen in a disc of their own: what a Brazilian test cuts. @param flat_angle_rad  of each of two flats; 0: a
/// whole disc
SpecimenSpec disc_of(const SpecimenSpec& specimen, double diameter_m, double flat_angle_rad = 0.0);

/// Calls `change(SpecimenSpec&)` for every specimen of the job.
template <class Change>
void for_each_specimen(Job& job, const Change& change) {
    change(job.specimen);
    for (TestSpec& test : job.tests)
        if (test.specimen) change(*test.specimen);
}

/// The job with every default written out, as TOML in SI units: what runs are known by.
std::string resolved_toml(const Job& job);

/// The same with the user's units, where a value that the user has written is the same to the last bit: provenance that can be
/// read, and run again.
std::string resolved_toml_in_given_units(const Job& job);

}  // namespace feldspar
