// The sections of a job file, each read by one function. For this room and for study files, which lay pieces over a job: others
// call read_job().
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "feldspar/job/job.hpp"
#include "feldspar/job/job_table.hpp"
#include "feldspar/methods/test_spec.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// The texts of a file in which a number may stand, each with the key that it belongs to.
std::vector<WrittenText> texts_of(const toml::table& tree);

/// A whole job from its tree. @param text  as it was read, for provenance; @param name  stands in for the file in messages
Job read_tree(toml::table tree, const std::string& text, const std::string& name);

/// [specimen]. A relative path of a packing counts from `folder`; `filled`: some grains are made of inner particles; nothing if a
/// mistake in the models leaves that open. @param phases  minerals, some of which have sizes of their own; empty: none has. The
/// others take those of [specimen.grains]
SpecimenSpec read_specimen(const JobTable& root, const std::filesystem::path& folder, std::optional<bool> filled,
                           const std::vector<Mineral>& phases);

/// `diameter` or `crystals`: how grains' diameters are distributed.
GrainSizeSpec read_grain_sizes(const JobTable& table, std::string_view key);

/// `holes`, `notches` and `labels` of [specimen].
void read_cutouts(const JobTable& table, OutlineSpec& outline);
/// Whether holes and notches fit the outline, the grains and each other.
void check_cutouts(const JobTable& table, const SpecimenSpec& specimen);

/// [model], [material] and [numerics] of the job, or of one of its variants, whose tables lie over the job's.
struct Physics {
    ModelSpec model;
    GrainMaterial grain;
    ContactMaterial contact;
    Heterogeneity rock;
    NumericsSpec numerics;
};
/// A friction coefficient, given itself or by its angle; nothing without either.
std::optional<double> read_friction(const JobTable& table);

/// What makes grains and contacts of [material] differ. @param model_decided_at  level of the table that chose the kind of grains
/// @param grain, contact  of [material.grain] and [material.contact], for what minerals, pairs and joints do not give
Heterogeneity read_rock(const JobTable& material, const ModelSpec& model, bool model_known, int model_decided_at,
                        const GrainMaterial& grain, const ContactMaterial& contact);

Physics read_physics(const JobTable& root, const JobTable* variant);

/// What kinds of grains the job and its variants have was read without a mistake.
bool kinds_known(const TableReader& root, const std::vector<Variant>& variants);

/// [[variant]]: always one at least; a job without the list has one without a name.
std::vector<Variant> read_variants(const JobTable& root);

/// The minerals of the job, if some have sizes of their own; else none. A mistake where variants do not agree in them: they share
/// packings.
std::vector<Mineral> minerals_with_sizes(const JobTable& root, const std::vector<Variant>& variants);

/// A mistake for each variant whose seeds or tests are not the job's, or which would run nothing.
void check_variants(const JobTable& root, const Job& job);

/// The levels of tables that lie over each other; a preset's is one more than that of the table that names it.
inline constexpr int variant_level = 0;
inline constexpr int job_level = 2;

/// `specimen` of a test: the job's grains in an outline of its own.
SpecimenSpec read_own_specimen(const JobTable& test, const SpecimenSpec& of_job, bool grains_known);

/// Keys on which an outline rests.
inline constexpr std::array<std::string_view, 10> outline_keys{"shape",    "width",       "height", "diameter", "hole_diameter",
                                                               "vertices", "edge_labels", "arcs",   "holes",    "notches"};

/// [[test]], lists of sigma3 expanded.
std::vector<TestSpec> read_tests(const JobTable& root, const SpecimenSpec& specimen, const std::vector<Variant>& variants,
                                 const std::vector<std::uint64_t>& run_seeds);

/// What a method has of its own among the keys of a test: span and rollers of a beam, fixtures and gauges of a custom test, a
/// gauge that ends it.
void read_own_keys(const JobTable& table, TestSpec& test);

/// `stages` of a test, with whether they can end one after the other.
std::vector<StageGroup> read_stages(const JobTable& table, const TestSpec& test, bool limited_steps);

/// Names of the gauges of a test: those of the method, or of the user.
std::vector<std::string_view> gauge_names(const TestSpec& test);
bool has_gauge(const TestSpec& test, std::string_view gauge);
/// In which its readings are given.
Dimension dimension_of_gauge(const TestSpec& test, std::string_view gauge);

/// [run]: seeds, threads and tests at once.
struct RunSettings {
    std::vector<std::uint64_t> seeds{1};
    int threads = 0;
    int at_once = 0;
};
RunSettings read_run(const JobTable& root);

/// [laboratory], in SI.
std::map<std::string, double> read_laboratory(const JobTable& root);
/// Its list `confined`.
std::vector<ConfinedStrength> read_laboratory_confined(const JobTable& root);

/// `tests` of a table: kinds of test, each once; none if the key is not there.
std::vector<MethodId> read_kinds(const TableReader& table);

/// A list of seeds: whole numbers, each once.
std::vector<std::uint64_t> read_seed_list(const TableReader& table, std::string_view key);

/// Diameter of the largest grain, and the mean diameter by which a size distribution is judged here.
double largest_diameter_m(const GrainSizeSpec& sizes);
double typical_diameter_m(const GrainSizeSpec& sizes);

/// The smallest extent of an outline: its sides along the axes; disc by its diameter.
double smallest_extent_m(const OutlineSpec& outline);

}  // namespace feldspar
