// The sections of a job file, each read by one function. Internal to this room: others call read_job().
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "feldspar/model/spec.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/study/job.hpp"
#include "feldspar/study/toml_reader.hpp"

namespace feldspar {

/// [specimen]. A relative path of a packing counts from `folder`.
SpecimenSpec read_specimen(const TableReader& root, const std::filesystem::path& folder);

/// [model]; every key has a default.
ModelSpec read_model(const TableReader& root);

/// [material.grain] and [material.contact].
GrainMaterial read_grain_material(const TableReader& material, const ModelSpec& model);
ContactMaterial read_contact_material(const TableReader& material);

/// [numerics]; every key has a default except the speed of `kind = "dynamic"`.
NumericsSpec read_numerics(const TableReader& root);

/// [[test]], lists of sigma3 expanded.
struct TestList {
    std::vector<TestSpec> tests;
    std::optional<double> brazilian_diameter_m;  ///< present if there is a Brazilian test
};
TestList read_tests(const TableReader& root, const SpecimenSpec& specimen, const std::vector<std::uint64_t>& run_seeds);

/// [run]: seeds and threads.
struct RunSettings {
    std::vector<std::uint64_t> seeds{1};
    int threads = 0;
};
RunSettings read_run(const TableReader& root);

/// [laboratory], in SI.
std::map<std::string, double> read_laboratory(const TableReader& root);

/// A list of seeds: whole numbers, each once.
std::vector<std::uint64_t> read_seed_list(const TableReader& table, std::string_view key);

/// Diameter of the largest grain, and the mean diameter by which a size distribution is judged here.
double largest_diameter_m(const GrainSizeSpec& sizes);
double typical_diameter_m(const GrainSizeSpec& sizes);

/// The smallest extent of an outline: rectangle and polygon by their sides along the axes, disc by its diameter.
double smallest_extent_m(const OutlineSpec& outline);

}  // namespace feldspar
