#include "feldspar/job/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "feldspar/job/format.hpp"
#include "feldspar/job/presets.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/model/heterogeneity_spec.hpp"

namespace feldspar {
namespace {

using enum Dimension;

constexpr double infinite = std::numeric_limits<double>::infinity(), degree = std::numbers::pi / 180.0;

constexpr double usual_particles_per_grain = 26.36;  // 42966 in 1630 grains, as in the paper
constexpr double usual_flat_angle_rad = 20.0 * degree;

constexpr Range below_one{0.0, 1.0, true, false, "0 or greater and less than 1"};
constexpr Range inside_one{0.0, 1.0, false, false, "greater than 0 and less than 1"};
constexpr Range share{0.0, 1.0, true, true, "from 0 % to 100 %"};
constexpr Range poisson{-1.0, 0.5, false, false, "greater than -1 and less than 0.5"};
constexpr Range below_right_angle{0.0, 90.0 * degree, true, false, "from 0 to less than 90 deg"};
// angles that (P31) was computed for, and that laboratories use
constexpr Range flat_angles{10.0 * degree, 40.0 * degree, true, true, "from 10 to 40 degrees (20 to 30 are usual)"};
// a hair wider than stated, for 0.05 % is not the same double as 0.0005
constexpr Range accuracies{0.0005 * (1.0 - 1e-12), 0.1 * (1.0 + 1e-12), true, true, "from 0.05 % to 10 %"};
constexpr Range confining{0.0, infinite, false, true, "greater than zero (for zero: kind = \"uniaxial-compression\")"};

// What stands behind a key.
KeyValue quantity(Dimension dimension, const Range& range = positive, std::vector<std::string> words = {}) {
    return {{ValueForm::quantity, dimension, range, std::move(words)}};
}
KeyValue number(const Range& range) { return {{ValueForm::number, fraction, range}}; }
KeyValue share_of_one(const Range& range, std::string_view unit = "") {
    return {{ValueForm::fraction, fraction, range}, ValueShape::one, {}, unit};
}
KeyValue integer(double low, double high = infinite, std::vector<std::string> words = {}) {
    return {{ValueForm::integer, fraction, {low, high, true, true, {}}, std::move(words)}};
}
KeyValue flag() { return {{ValueForm::flag}}; }
KeyValue text(std::string_view allowed = "text in quotes") { return {{ValueForm::text, fraction, {.words = allowed}}}; }
KeyValue choice(std::vector<std::string> words) { return {{ValueForm::choice, fraction, any_value, std::move(words)}}; }
template <std::ranges::range Values>
KeyValue choice_of(const Values& values) {
    std::vector<std::string> words;
    for (const auto value : values) words.emplace_back(name(value));
    return choice(std::move(words));
}
KeyValue choice(std::span<const Preset> presets) {
    std::vector<std::string> words;
    for (const Preset& preset : presets) words.emplace_back(preset.name);
    return choice(std::move(words));
}
KeyValue table(std::string_view path) { return {{ValueForm::table, fraction, any_value, {}, path}}; }
KeyValue tables(std::string_view path) { return {table(path).element, ValueShape::tables}; }
KeyValue list_of(KeyValue value) { return {std::move(value.element), ValueShape::list}; }
KeyValue one_or_list_of(KeyValue value) { return {std::move(value.element), ValueShape::one_or_list}; }
KeyValue point() { return list_of(quantity(length, any_value)); }  // x and y
KeyValue control_words() {                                         // or the name of a gauge
    KeyValue value = text("the name of a gauge");
    for (const LoadControl control : load_controls) value.element.words.emplace_back(name(control));
    return value;
}
KeyValue stage_ends_and_gauges() {
    KeyValue value = text("the name of a gauge");
    for (const StageEnd end : stage_ends) value.element.words.emplace_back(name(end));
    return value;
}
KeyValue direction() { return list_of(number(any_value)); }
KeyValue pairs_of(KeyValue first, KeyValue second) {
    return {std::move(first.element), ValueShape::pairs, std::move(second.element)};
}

// What holds without it.
const KeyDefault needed{.need = KeyNeed::always, .words = "must be given"},
    must{.need = KeyNeed::where_it_applies, .words = "must be given"}, none{.words = "none"};
KeyDefault words(std::string text) { return {.words = std::move(text)}; }
KeyDefault usual(double value) { return {.value = value}; }
KeyDefault usual_word(std::string_view word) { return {.toml = fmt::format("\"{}\"", word)}; }

// Where it applies.
template <class Value>
KeyCondition with(std::string_view key, std::initializer_list<Value> values) {
    KeyCondition condition{key, {}};
    for (const Value value : values) condition.words.emplace_back(name(value));
    return condition;
}
template <std::ranges::range Values, class Takes>
KeyCondition where(std::string_view key, const Values& values, Takes takes) {
    KeyCondition condition{key, {}};
    for (const auto value : values)
        if (takes(value)) condition.words.emplace_back(name(value));
    return condition;
}
template <class Such>
KeyCondition methods_that_are(const Such& such) {
    return where("kind", test_methods(), [&](MethodId kind) { return such(method_of(kind)); });
}
KeyCondition numerics_that_are(bool (*such)(NumericsKind)) { return where("kind", numerics_kinds, such); }
bool uses_specimen(const TestMethod& method) { return !method.specimen.own_disc; }
bool own_disc(const TestMethod& method) { return method.specimen.own_disc; }
bool confined(const TestMethod& method) { return method.specimen.confined; }
bool sheared(const TestMethod& method) { return method.specimen.sheared; }
bool takes_friction(const TestMethod& method) { return !method.specimen.glued && !method.specimen.fixtures_of_job; }
bool users_own(const TestMethod& method) { return method.specimen.fixtures_of_job; }
bool has_gauges(const TestMethod& method) { return method.build.gauges != nullptr; }
bool adaptive(NumericsKind kind) { return kind == NumericsKind::adaptive; }
bool not_adaptive(NumericsKind kind) { return kind != NumericsKind::adaptive; }
bool dynamic(NumericsKind kind) { return kind == NumericsKind::dynamic; }
bool not_dynamic(NumericsKind kind) { return kind != NumericsKind::dynamic; }

// The stiffness and friction of plates that tests have unless a job says otherwise.
std::string usual_plate_Kn() {
    for (const MethodId kind : test_methods())
        if (const auto Kn = usual_test(kind).plate_Kn_Pa_m)
            return fmt::format("curved plates: `{}`, a layer of masking tape", as_written(quantity(stiffness_gradient), *Kn));
    return "none";
}
std::string usual_plate_mu() {
    std::string text;
    for (const MethodId kind : test_methods())
        if (const double mu = method_of(kind).specimen.plate_mu; mu > 0.0)
            text += fmt::format("{:g} with `kind = \"{}\"`, ", mu, name(kind));
    return text + "else 0";
}

std::vector<JobKey> file_keys() {
    return {
        {"name", text("up to 100 letters, digits, '-', '_' and '.', not beginning with '.'"), words("the file's name"),
         "names the directory of the results"},
        {"format", integer(1, job_format), usual(job_format),
         "version of the format of the file (docs/formats.md), for jobs that are to be read by later versions of the program"},
        {"specimen", table("specimen"), needed, "the specimen"},
        {"model", table("model"), words("its defaults"), "how grains and contacts are modelled"},
        {"material", table("material"), must, "the rock"},
        {"numerics", table("numerics"), words("its defaults"), "how a test is loaded and how accurate its strength is to be"},
        {"variant", tables("variant"), words("the job is one model"), "several models of the same packings, to be compared"},
        {"test", tables("test"), needed, "the tests"},
        {"run", table("run"), words("its defaults"), "packings and threads"},
        {"laboratory", table("laboratory"), none, "what a laboratory measured, shown beside the results"},
    };
}

// The shapes, and that of the cells of a file.
KeyValue choice_of_shapes() {
    KeyValue value = choice_of(shapes);
    value.element.words.emplace_back(shape_from_file);
    return value;
}

// What outlines are made of.
std::vector<JobKey> outline_rows() {
    const KeyCondition rectangle = with("shape", {Shape::rectangle}),
                       disc = with("shape", {Shape::disc, Shape::half_disc, Shape::ring}),
                       polygon = with("shape", {Shape::polygon});
    return {
        {"shape", choice_of_shapes(), needed,
         "the outline: `\"from-file\"`: that of the cells that `file` of `[specimen.grains]` names; a rectangle (`width`, "
         "`height`: from (0, 0)), a disc (`diameter`: around (0, 0)), a polygon (`vertices`, `edge_labels`), a half disc "
         "(`diameter`; it stands on y = 0 with the middle of its flat at (0, 0); labels `\"flat\"`, `\"arc\"`) or a ring "
         "(`diameter`, `hole_diameter`; labels `\"circle\"`, `\"hole\"`)"},
        {"width", quantity(length), must, "across the load; the Brazilian test cuts its own disc of this diameter", rectangle},
        {"height", quantity(length), must, "in the direction of loading", rectangle},
        {"diameter", quantity(length), must, "outer diameter", disc},
        {"hole_diameter", quantity(length), must, "diameter of the hole", with("shape", {Shape::ring})},
        {"vertices", pairs_of(quantity(length, any_value), quantity(length, any_value)), must,
         "corners of the outline, x and y each, 3 to 10000; they may run either way round", polygon},
        {"edge_labels", list_of(text()), words("none; needed by tests that press on flat ends"),
         "one label an edge, edge i from vertex i to vertex i + 1: `\"top\"` on the upper end and `\"bottom\"` on the lower one, "
         "both within 10 degrees of "
         "horizontal; the load acts along y",
         polygon},
        {"arcs", tables("specimen.arcs"), none, "round edges of the polygon", polygon},
        {"holes", tables("specimen.holes"), none,
         "holes, in any outline: not smaller than the largest grain, half a mean grain or more from the boundary and each other"},
        {"notches", tables("specimen.notches"), none,
         "sawn slits with square ends, which begin at a boundary or at a hole or lie inside: longer than the largest grain, half "
         "a mean grain or more from each "
         "other, and not through the specimen"},
        {"labels", tables("specimen.labels"), none,
         "further labels by place, for edges of grains on the boundary whose middle lies there; the last that catches an edge "
         "counts, one that catches none is an error"},
    };
}

std::vector<JobKey> specimen_keys() {
    const SpecimenSpec spec;
    std::vector<JobKey> keys = outline_rows();
    std::vector<JobKey> further{
        {"thickness", quantity(length), usual(spec.thickness_m), "out of plane; scales forces, not stresses"},
        {"packing", text("a packing saved by an earlier run, its path relative to the job file"),
         words("a new one for each seed"), "a packing that is loaded instead of made"},
        {"grains", table("specimen.grains"), needed, "sizes of the grains and what is in them"},
    };
    std::ranges::move(further, std::back_inserter(keys));
    return keys;
}

std::vector<JobKey> arc_keys() {
    return {
        {"edge", integer(0, 10000), needed, "the edge from vertex `edge`, counted from 0, to the next"},
        {"through", point(), needed, "a point beside the edge: the arc goes from the one vertex through it to the other"},
    };
}

std::vector<JobKey> hole_keys() {
    return {
        {"centre", point(), words("must be given, or `vertices`"), "centre of a round hole"},
        {"diameter", quantity(length), words("must be given, or `vertices`"), "diameter of a round hole"},
        {"vertices", pairs_of(quantity(length, any_value), quantity(length, any_value)), none,
         "corners of a polygonal hole, in place of `centre` and `diameter`"},
        {"label", text(), words("`\"hole-1\"`, `\"hole-2\"`, ..."), "label of its boundary"},
    };
}

std::vector<JobKey> notch_keys() {
    return {
        {"from", point(), needed, "where it begins, on the boundary or inside"},
        {"to", point(), needed, "where it ends"},
        {"width", quantity(length, not_negative), needed, "`\"0 mm\"`: a cut whose faces touch, and nothing joins them"},
        {"label", text(), words("`\"notch-1\"`, `\"notch-2\"`, ..."), "label of its faces"},
        {"joined", flag(), usual(0.0),
         "the faces of a cut of width 0 stay in contact: a smooth joint, to which a `[[material.joint]]` with `cut` gives its "
         "law; it may go through the specimen, cross other joined cuts, or end on one"},
    };
}

std::vector<JobKey> label_keys() {
    return {
        {"name", text(), needed, "the label"},
        {"at", point(), words("`at`, `box` or `line` must be given"), "edges within a distance of this point"},
        {"within", quantity(length), words("of a line `\"0.01 mm\"`; of a point it must be given"), "the distance"},
        {"box", pairs_of(quantity(length, any_value), quantity(length, any_value)), none,
         "edges in a box, by two opposite corners"},
        {"line", pairs_of(quantity(length, any_value), quantity(length, any_value)), none, "edges along a line, by its two ends"},
    };
}

std::vector<JobKey> grains_keys() {
    const SpecimenSpec spec;
    return {
        {"diameter", table("specimen.grains.diameter"), words("must be given, or `file`, or that of each `[[material.phase]]`"),
         "the distribution of diameters; of discs, which the cells exceed ([by how much](theory/specimen.md))"},
        {"crystals", table("specimen.grains.diameter"), words("each grain is a crystal"),
         "the distribution of diameters of crystals that consist of several grains each, and can break between them "
         "(`[material.crystal]`)"},
        {"porosity", number(below_one), usual(spec.porosity), "sets the number of grains only: the grains fill the plane"},
        {"merge_length", quantity(length, not_negative, {"auto", "none"}), usual_word("auto"),
         "shorter grain edges are merged; `\"auto\"` is mean diameter / 12"},
        {"triangles_per_grain", integer(0, 10000), usual(spec.triangles_per_grain),
         "0 for the standard mesh of about 15 triangles, or about so many"},
        {"file", text("the path of a .tess, .msh or .csv file, relative to the job file"), words("the grains are packed"),
         "cells that another program made, in place of a packing ([theory](theory/specimen.md#7-cells-of-other-programs)): a "
         "tessellation of Neper (`.tess`), a mesh of gmsh whose surfaces are the grains (`.msh`), or polygons (`.csv`, head "
         "`grain,x,y`)"},
        {"unit", text("a unit or a length, such as \"mm\" or \"80 mm\""),
         words("must be given with `file`, unless a `.csv` says it in its head"),
         "the length of one unit of the file, which has no units: `\"80 mm\"` makes of Neper's unit square one of 80 mm"},
        {"tolerance", number({0.0, 0.1, true, true, "from 0 to 0.1"}), usual(spec.given_cells.tolerance),
         "of a file's cells, in mean grain diameters: corners of neighbours that are nearer are one, a corner so near to a "
         "neighbour's edge goes into it, and the boundary may miss the outline by so much"},
        {"particles_per_grain", number({7.0, 500.0, true, true, "from 7 to 500"}), usual(usual_particles_per_grain),
         "inner particles in a grain of mean area", with("model.kind", {GrainKind::inner_particles})},
    };
}

std::vector<JobKey> diameter_keys() {
    const KeyCondition bounded_kinds = with("distribution", {GrainSizeKind::uniform, GrainSizeKind::log_normal}),
                       log_normal = with("distribution", {GrainSizeKind::log_normal});
    return {
        {"distribution", choice_of(grain_size_kinds), needed, "how diameters are distributed"},
        {"minimum", quantity(length), must, "the smallest", bounded_kinds},
        {"maximum", quantity(length), must, "the largest", bounded_kinds},
        {"median", quantity(length), must, "the median, between the smallest and the largest", log_normal},
        {"log_standard_deviation", number({0.0, 3.0, false, true, "greater than 0, at most 3"}), must,
         "standard deviation of the natural logarithm of the diameter", log_normal},
        {"curve", pairs_of(quantity(length), share_of_one(share)), must,
         "sieves of increasing diameter and the share by mass that passes each, from 0 % to 100 %; it may have flat parts",
         with("distribution", {GrainSizeKind::sieve})},
    };
}

std::vector<JobKey> model_keys() {
    const ModelSpec spec;
    return {
        {"kind", choice_of(grain_kinds), usual_word(name(spec.kind)),
         "`\"flexible\"`: grains of elastic triangles; `\"rigid\"`: three degrees of freedom a grain; `\"inner-particles\"`: "
         "grains filled with small rigid "
         "particles on unbreakable elastic contacts"},
        {"contact", choice_of(contact_kinds), usual_word(name(spec.contact)),
         "`\"lobatto3\"`: three points on a grain edge; `\"point\"`: one. Inner particles always have one"},
        {"normal", choice_of(contact_normals), usual_word(name(spec.normal)),
         "`\"centres\"`: from centre to centre; `\"edge\"`: that of the Laguerre edge, between inner particles of two grains"},
        {"plane",
         choice_of(plane_states),
         usual_word(name(spec.plane)),
         "plane stress or plane strain",
         {},
         false,
         {},
         "of flexible grains"},
    };
}

std::vector<JobKey> material_keys() {
    return {
        {"elastic_preset", choice(elastic_presets()), none,
         "stiffnesses of the literature by name ([below](#presets)), under what the tables give"},
        {"strength_preset", choice(strength_presets()), none,
         "a law and its strengths by name ([below](#presets)), under what the tables give"},
        {"grain", table("material.grain"), words("that of presets; must be given of flexible grains"), "the grains"},
        {"contact", table("material.contact"), words("that of presets; else it must be given"), "the contacts between grains"},
        {"phase", tables("material.phase"), words("one mineral"), "the minerals of the rock ([theory](theory/heterogeneity.md))"},
        {"pair", tables("material.pair"), words("by `unlike` of `[material.minerals]`"),
         "contacts between two minerals, or of one with itself, where they differ from `[material.contact]`"},
        {"crystal", table("material.crystal"), words("as `[material.contact]`"),
         "contacts inside crystals, where they differ from `[material.contact]`"},
        {"minerals", table("material.minerals"), words("at random"), "how the minerals lie in the specimen"},
        {"scatter", table("material.scatter"), none, "what scatters from contact to contact, or from grain to grain"},
        {"initial_cracks", table("material.initial_cracks"), none, "contacts that are not whole before the test"},
        {"joint", tables("material.joint"), none,
         "joints, bedding planes and cracks: along the grain edges nearest to their traces"},
    };
}

std::vector<JobKey> phase_keys() {
    return {
        {"name", text("1 to 40 letters, digits, '_' and '-'"), needed, "the mineral"},
        {"share", share_of_one(share, "%"), needed, "of the area; all shares add up to 1"},
        {"E", quantity(stress), words("that of `[material.grain]`"), "Young's modulus of its grains",
         with("model.kind", {GrainKind::flexible}), false,
         ": these grains have no elastic constants, they deform by Kn and eta of their contacts"},
        {"nu", number(poisson), words("that of `[material.grain]`"), "Poisson's ratio of its grains",
         with("model.kind", {GrainKind::flexible}), false,
         ": these grains have no elastic constants, they deform by Kn and eta of their contacts"},
        {"density", quantity(density), words("that of `[material.grain]`"), "density of its grains"},
        {"colour", text("a colour such as \"#b08050\""), words("one of a palette"), "in pictures and in a map"},
        {"value", integer(0, 255), words("its `colour`"), "of its pixels in a map that is a grey picture of numbers"},
        {"diameter", table("specimen.grains.diameter"), words("that of `[specimen.grains]`"),
         "the distribution of the diameters of its grains ([theory](theory/heterogeneity.md#7-sizes-by-mineral)): the packing "
         "then says which grain is of which mineral. If every mineral has its own, `[specimen.grains]` has none"},
    };
}

std::vector<JobKey> pair_keys() {
    return {
        {"phases", list_of(text("two names of phases")), needed,
         "the two minerals; twice the same: contacts of a mineral with itself"},
        {"inside", flag(), usual(0.0),
         "of a mineral with itself: the contacts inside its crystals, not those between two of them"},
        {"Kn", quantity(stiffness_gradient), words("that of `[material.contact]`"), "normal stiffness per area"},
        {"eta", number(positive), words("that of `[material.contact]`"), "shear over normal stiffness"},
        {"sigma_nt", quantity(stress), words("that of `[material.contact]`"), "tensile strength"},
        {"tau", quantity(stress), words("that of `[material.contact]`"), "cohesion"},
        {"mu", number(not_negative), words("that of `[material.contact]`"), "friction coefficient"},
        {"phi", quantity(angle, below_right_angle), none, "the friction angle, tan phi = mu, in place of `mu`"},
        {"Gfn", quantity(fracture_energy), words("that of `[material.contact]`"), "fracture energy in tension"},
        {"Gfs", quantity(fracture_energy), words("that of `[material.contact]`"), "fracture energy in shear"},
    };
}

std::vector<JobKey> crystal_keys() {
    std::vector<JobKey> keys = pair_keys();
    std::erase_if(keys, [](const JobKey& key) { return key.name == "phases" || key.name == "inside"; });
    return keys;
}

std::vector<JobKey> minerals_keys() {
    const MineralSpec spec;
    return {
        {"unlike", choice_of(unlike_rules), usual_word(name(spec.unlike)),
         "contacts of two unlike minerals without a `[[material.pair]]`: `\"weaker\"`: the smaller of each value of the two "
         "minerals' own contacts; `\"mean\"`: their mean; `\"given\"`: every pair must be given"},
        {"unlike_strength", number({0.0, 1.0, false, true, "greater than 0, at most 1"}), usual(spec.unlike_strength),
         "multiplies the strengths and fracture energies of such contacts"},
        {"cluster_length", quantity(length, not_negative), usual(spec.cluster_length_m),
         "grains of a mineral lie together over this length; 0: each grain by itself, at random"},
        {"map", text("a PNG picture, its path relative to the job file"), none,
         "a scanned thin section over the whole specimen: colours are those of the phases; black without a phase is nothing"},
        {"list", text("a text file, its path relative to the job file"), none,
         "the mineral of each grain by name, a line each, in the order of the packing"},
    };
}

std::vector<JobKey> scatter_keys() {
    const ScatterSpec spec;
    std::vector<JobKey> keys;
    const auto meaning = [](Scattered quantity) -> std::string {
        switch (quantity) {
            case Scattered::strength:
                return "`sigma_nt` and `tau` of a contact together";
            case Scattered::sigma_nt:
                return "`sigma_nt` by itself, on top of `strength`";
            case Scattered::tau:
                return "`tau` by itself, on top of `strength`";
            case Scattered::stiffness:
                return "`Kn` and the shear stiffness of a contact together";
            case Scattered::Kn:
                return "`Kn` by itself, on top of `stiffness`; the shear stiffness stays";
            case Scattered::Ks:
                return "the shear stiffness by itself, on top of `stiffness`";
            case Scattered::mu:
                return "the friction coefficient of a contact";
            case Scattered::Gfn:
                return "`Gfn` by itself, on top of what follows from the strength";
            case Scattered::Gfs:
                return "`Gfs` by itself, on top of what follows from the strength";
            case Scattered::E:
                return "Young's modulus of a flexible grain";
        }
        return {};
    };
    for (const Scattered quantity : scattered_quantities)
        keys.push_back({name(quantity), table("material.scatter.strength"), none, meaning(quantity)});
    keys.push_back({"energy_power", number({0.0, 10.0, true, true, "from 0 to 10"}), usual(spec.energy_power),
                    "a fracture energy is multiplied by the factor of its strength to this power: with 2 the softening scales as "
                    "a whole, with 1 its displacements stay"});
    return keys;
}

std::vector<JobKey> distribution_keys() {
    return {
        {"distribution", choice_of(distribution_kinds), usual_word(name(DistributionKind::weibull)), "of a factor of mean 1"},
        {"modulus", number({0.2, 1000.0, true, true, "from 0.2 to 1000"}), words("must be given, or `variation`"),
         "Weibull modulus; rocks have 1.5 to 6", with("distribution", {DistributionKind::weibull})},
        {"variation", share_of_one({0.0, 2.0, false, true, "greater than 0, at most 200 %"}, "%"),
         words("must be given; with `\"weibull\"` in place of `modulus`"), "coefficient of variation"},
        {"lowest", number(below_one), words("0; with `\"normal\"` 0.05"), "smallest factor: the distribution is cut off there"},
        {"highest", number({1.0, infinite, false, true, "greater than 1"}), words("no limit"), "largest factor"},
        {"correlation_length", quantity(length, not_negative), usual(0.0),
         "draws so far apart are correlated by exp(-1/2) (a Gaussian random field); 0: independent"},
    };
}

std::vector<JobKey> initial_cracks_keys() {
    const InitialCracks spec;
    return {
        {"broken", share_of_one(share, "%"), usual(spec.broken), "share of the contacts that have no strength"},
        {"opening", quantity(length, not_negative), usual(spec.opening_m),
         "of these: their faces meet when the gap has closed by it"},
        {"weakened", share_of_one(share, "%"), usual(spec.weakened),
         "share of the contacts whose strengths are multiplied by `weakened_strength`"},
        {"weakened_strength", number({0.0, 1.0, false, true, "greater than 0, at most 1"}),
         words("must be given beside `weakened`"), "that factor; fracture energies follow by `energy_power`"},
    };
}

std::vector<JobKey> joint_keys() {
    return {
        {"name", text("1 to 40 letters, digits, '_' and '-'"), words("`\"joint-1\"`, `\"joint-2\"`, ..."), "the joint"},
        {"cut", text("the label of a notch with `joined = true`"), words("`trace`, `cut`, `file` or `set` must be given"),
         "a smooth joint: the faces of this cut, or of all cuts with this label"},
        {"trace", pairs_of(quantity(length, any_value), quantity(length, any_value)),
         words("`trace`, `cut`, `file` or `set` must be given"), "a rough joint: a polyline of two points or more"},
        {"file", text("a CSV or DXF file, its path relative to the job file"),
         words("`trace`, `cut`, `file` or `set` must be given"),
         "rough joints: traces: CSV with a head `x1,y1,x2,y2` and lengths in m or in the `unit`, or DXF with LINE, LWPOLYLINE "
         "and POLYLINE"},
        {"unit", text("a unit of length such as \"mm\""), words("CSV: m; DXF: that of its $INSUNITS, which must be there"),
         "of the lengths in the file"},
        {"layer", text("a layer of the DXF file, or what stands in a column `set` of the CSV file"), words("all"),
         "which traces of the file"},
        {"set", table("material.joint.set"), words("`trace`, `cut`, `file` or `set` must be given"),
         "rough joints: parallel traces, drawn from the seed"},
        {"Kn", quantity(stiffness_gradient), words("that of `[material.contact]`"), "normal stiffness per area"},
        {"eta", number(positive), words("that of `[material.contact]`"), "shear over normal stiffness"},
        {"sigma_nt", quantity(stress, not_negative), words("0"), "tensile strength"},
        {"tau", quantity(stress, not_negative), words("0"),
         "cohesion; without it and `sigma_nt` the joint slides from the start"},
        {"mu", number(not_negative), words("that of `[material.contact]`"), "friction coefficient"},
        {"phi", quantity(angle, below_right_angle), none, "the friction angle, tan phi = mu, in place of `mu`"},
        {"Gfn", quantity(fracture_energy, not_negative), words("0: brittle in tension"), "fracture energy in tension"},
        {"Gfs", quantity(fracture_energy, not_negative), words("0: brittle in shear"), "fracture energy in shear"},
        {"opening", quantity(length, not_negative), usual(0.0),
         "of a joint without strength: its faces meet when the gap has closed by it"},
        {"dilation", quantity(angle, {0.0, 89.0 * degree, true, true, "from 0 to the friction angle"}), usual(0.0),
         "dilation angle: broken faces that are closed and slide open by its tangent times the slip; a part of the friction "
         "angle, which is the whole one ([theory](theory/heterogeneity.md#8-joints-that-dilate))"},
        {"dilation_slip", quantity(length), words("must be given beside `dilation`"),
         "the slip after which the joint dilates no more"},
    };
}

std::vector<JobKey> joint_set_keys() {
    const Range angles{-180.0 * degree, 180.0 * degree, true, true, "from -180 to 180 degrees"};
    return {
        {"dip", quantity(angle, angles), needed, "from the x axis, counter-clockwise"},
        {"dip_deviation", quantity(angle, {0.0, 45.0 * degree, true, true, "from 0 to 45 degrees"}), usual(0.0),
         "standard deviation of the dip from trace to trace"},
        {"spacing", quantity(length), needed, "mean distance of neighbouring traces"},
        {"spacing_variation", share_of_one(share, "%"), usual(0.0), "coefficient of variation of the spacing (log-normal)"},
        {"length", quantity(length), words("through the whole specimen"), "mean length of a trace"},
        {"length_variation", share_of_one(share, "%"), usual(0.0), "coefficient of variation of the length (log-normal)"},
        {"persistence", share_of_one({0.0, 1.0, false, true, "greater than 0, at most 100 %"}, "%"),
         words("1; must be given beside `length`"), "share of its line that traces take up"},
    };
}

std::vector<JobKey> grain_keys() {
    const GrainMaterial spec;
    const KeyCondition flexible = with("model.kind", {GrainKind::flexible});
    constexpr std::string_view why_not = ": these grains have no elastic constants, they deform by Kn and eta of their contacts";
    return {
        {"E", quantity(stress), must,
         "Young's modulus of the grains; other grains have no elastic constants, they deform by `Kn` and `eta`", flexible, false,
         why_not},
        {"nu", number(poisson), must, "Poisson's ratio of the grains", flexible, false, why_not},
        {"density", quantity(density), usual(spec.density_kg_m3), "density of the grains"},
    };
}

std::vector<JobKey> contact_keys() {
    const ContactMaterial spec;
    const KeyCondition softening = where("law", contact_laws, [](ContactLaw law) { return law != ContactLaw::brittle; });
    constexpr std::string_view why_not = ", which does not soften";
    return {
        {"law", choice_of(contact_laws), usual_word(name(spec.law)), "how a contact softens ([laws](theory/contacts.md))"},
        {"Kn", quantity(stiffness_gradient), must, "normal stiffness per area"},
        {"eta", number(positive), words("must be given, or `kratio`"), "shear over normal stiffness, ks/kn"},
        {"kratio", number(positive), words("must be given, or `eta`"), "the inverse, kn/ks, in place of `eta`"},
        {"sigma_nt", quantity(stress), must, "tensile strength"},
        {"tau", quantity(stress), must, "cohesion"},
        {"mu", number(not_negative), words("must be given, or `phi`"), "friction coefficient"},
        {"phi", quantity(angle, below_right_angle), words("must be given, or `mu`"),
         "the friction angle, tan phi = mu, in place of `mu`"},
        {"Gfn", quantity(fracture_energy), must, "fracture energy in tension", softening, false, why_not},
        {"Gfs", quantity(fracture_energy), must, "fracture energy in shear", softening, false, why_not},
        {"shear_measure", choice_of(shear_measures), usual_word(name(spec.shear_measure)),
         "damage counts the whole slip, or with `\"beyond-friction\"` only what friction does not carry", softening, false,
         why_not},
        {"tension_unloading", choice_of(tension_unloadings), usual_word(name(spec.tension_unloading)),
         "with the initial stiffness, or with `\"secant\"` back to the origin", softening, false, why_not},
    };
}

std::vector<JobKey> numerics_keys() {
    const NumericsSpec spec;
    return {
        {"kind", choice_of(numerics_kinds), usual_word(name(spec.kind)),
         "`\"adaptive\"`: finds its own loading rate; `\"paper\"`: fixed speed, local damping; `\"dynamic\"`: real masses"},
        {"accuracy", share_of_one(accuracies, "%"), usual(spec.accuracy),
         "relative accuracy wanted of a strength: the peak is passed again, more slowly, until the estimated error is that",
         numerics_that_are(adaptive)},
        {"residual_target", number({0.0, 0.5, false, true, "greater than 0, at most 0.5"}), words("that of `accuracy`"),
         "for experts: the target of the unbalanced force itself, in place of `accuracy`", numerics_that_are(adaptive)},
        {"damping", number(below_one), usual(spec.damping),
         "alpha of the local damping; with `\"adaptive\"` of what departs from the loading motion ([where it "
         "matters](validation/true-strengths.md))"},
        {"speed", quantity(speed_per_step),
         words(fmt::format("`{}`; with `\"dynamic\"` it must be given", as_written(quantity(speed_per_step), kPaperSpeed))),
         "of the platens: with `\"paper\"` a length per step, with `\"dynamic\"` a speed", numerics_that_are(not_adaptive), false,
         ", which finds its own speed"},
        {"mass_factor", number(positive), words("found by the program"),
         "for experts: multiplies the masses; judged before the run", numerics_that_are(not_dynamic)},
        {"time_step", quantity(Dimension::time), words("found by the program"), "for experts: judged before the run",
         numerics_that_are(dynamic)},
        {"maximum_steps", integer(1), words("2000 times what such a test usually takes; with fixed speeds no limit"),
         "stop there with what there is"},
        {"confirm", flag(), usual(spec.confirm ? 1.0 : 0.0),
         "repeat each test at a third of the target, and once more at another damping, and report both changes of the strength"},
    };
}

std::vector<JobKey> variant_keys() {
    return {
        {"name", text("up to 60 letters, digits, blanks and , . - _ % ( ) + =, with a letter or digit among them"), needed,
         "the files of the variant begin with it, so no two may differ only in blanks and signs"},
        {"seeds", list_of(integer(0)), words("all"), "some of `[run] seeds`"},
        {"tests", list_of(choice_of(test_methods())), words("all"), "kinds of test that the job has"},
        {"model", table("model"), words("the job's own"), "keys of `[model]`"},
        {"material", table("material"), words("the job's own"), "keys of `[material]`"},
        {"numerics", table("numerics"), words("the job's own"), "keys of `[numerics]`"},
    };
}

KeyValue value_of(const MethodKey& key) {
    switch (key.form) {
        case MethodKeyForm::quantity:
            return quantity(key.dimension, key.range);
        case MethodKeyForm::number:
            return number(key.range);
        case MethodKeyForm::share:
            return share_of_one(key.range);
        case MethodKeyForm::whole:
            break;
    }
    return integer(key.range.low, key.range.high);
}

// The keys that methods add. One that several have stands once.
std::vector<JobKey> keys_of_methods() {
    std::vector<JobKey> rows;
    for (const MethodId id : test_methods())
        for (const MethodKey& key : method_of(id).keys) {
            if (const auto known = std::ranges::find(rows, key.name, &JobKey::name); known != rows.end()) {
                if (*key.usual != 0 && known->usual.words.find(key.usual) == std::string::npos)
                    known->usual.words.append("; ").append(key.usual);
                continue;
            }
            const auto has_it = [&](const TestMethod& method) {
                return std::ranges::find(method.keys, key.name, &MethodKey::name) != method.keys.end();
            };
            const KeyDefault without = key.needed ? must : key.value ? usual(*key.value) : words(key.usual);
            rows.push_back({key.name, key.list ? one_or_list_of(value_of(key)) : value_of(key), without, key.meaning,
                            methods_that_are(has_it)});
        }
    return rows;
}

std::vector<JobKey> test_keys() {
    const TestSpec spec;
    std::vector<JobKey> keys{
        {"kind", choice_of(test_methods()), needed, "the method"},
        {"sigma3", one_or_list_of(quantity(stress, confining)),
         words("must be given; a plate with a hole has free sides without it"),
         "pressure on the sides; a list stands for one test each, or for the rising pressures of one multi-stage test",
         methods_that_are(confined)},
        {"normal_stress", one_or_list_of(quantity(stress, not_negative)), must,
         "normal stress on the plane that is sheared; a list stands for one test each", methods_that_are(sheared)},
        {"diameter", quantity(length), words("the specimen's width"), "diameter of the disc", methods_that_are(own_disc)},
        {"specimen", table("test.specimen"), words("the job's"),
         "a specimen of the test's own, of the same grains and thickness: an outline with holes, notches and labels",
         methods_that_are(uses_specimen)},
        {"disc", choice_of(disc_forms), usual_word(name(DiscForm::whole)),
         "`\"flattened\"`: cut by two parallel flats on which flat plates press", methods_that_are(own_disc)},
        {"flat_angle", quantity(angle, flat_angles), usual(usual_flat_angle_rad),
         "angle over which each flat of a flattened disc is seen from the centre; from 20 degrees on cracks start in the centre",
         methods_that_are(own_disc)},
        {"name", text("1 to 40 letters, digits, '_' and '-'"), must, "names the results of a test of your own",
         methods_that_are(users_own)},
    };
    std::ranges::move(keys_of_methods(), std::back_inserter(keys));
    std::vector<JobKey> further{
        {"stages", tables("test.stages"), none,
         "what the loading does, one stage after the other; without them it loads until the test ends "
         "([theory](theory/loading.md#7-stages))",
         methods_that_are(users_own)},
        {"stop_fraction", share_of_one(inside_one), usual(spec.stop_fraction),
         "the test ends when the stress has fallen to this fraction of the peak; in bending 0.1 and in direct shear 0.01 unless "
         "it is given"},
        {"control", control_words(),
         words("`\"dissipation\"` with adaptive numerics, in direct tension and the Brazilian test `\"displacement\"`"),
         "what the platens keep constant behind the peak, with adaptive numerics: `\"displacement\"`; `\"dissipation\"`: the "
         "work of fracture and friction in "
         "a travel time of a wave; "
         "`\"lateral-strain\"`: the growth of the lateral strain, in compression; the name of a gauge, such as `\"CMOD\"`: its "
         "growth ([theory](theory/loading.md)). The strength is the same"},
        {"maximum_strain", share_of_one(inside_one), usual(spec.maximum_strain),
         "the test ends at this axial strain at the latest"},
        {"maximum_stress", quantity(stress), none,
         "the test ends at this stress at the latest (under confinement: sigma1), and its strength is then a lower bound"},
        {"until", table("test.until"), none, "a gauge that ends the test", methods_that_are(has_gauges)},
        {"fixture", tables("test.fixture"), must, "what loads and holds the specimen", methods_that_are(users_own)},
        {"gauge", tables("test.gauge"), none, "what is read beside load and loading motion", methods_that_are(users_own)},
        {"length", quantity(length), words("the specimen's extent along the loading"),
         "strain is the loading motion over this length", methods_that_are(users_own)},
        {"width", quantity(length), words("the specimen's extent across the loading"),
         "stress is the load over this width times the thickness", methods_that_are(users_own)},
        {"gravity", quantity(acceleration), words("none"),
         "acceleration that gives all grains their weight, by `[material.grain] density`", methods_that_are(users_own)},
        {"gravity_direction",
         direction(),
         {.toml = "[0, -1]"},
         "x and y of the direction in which they weigh",
         methods_that_are(users_own)},
        {"snapshots", integer(0, 1000), usual(spec.snapshots), "fields kept between the first crack and the end"},
        {"seeds", list_of(integer(0)), words("those of the run"), "the packings of this test"},
        {"plates", choice_of(plate_shapes), words("`\"curved\"`; of a flattened disc `\"flat\"`"),
         "`\"curved\"` for jaws whose arcs embrace the disc ([why](decisions/2026-11-27-brazilian-fixture.md)), or `\"flat\"`",
         methods_that_are(own_disc), true},
        {"jaw_radius", number({1.0, 1000.0, false, true, "more than 1, in radii of the disc (ISRM: 1.5)"}),
         usual(spec.jaw_radius), "radius of curved plates, over that of the disc; 1.5 is ISRM's", methods_that_are(own_disc),
         true},
        {"plate_stiffness_factor",
         number(positive),
         words(fmt::format("{:g}; curved plates have a `plate_Kn`", spec.plate_stiffness_factor)),
         "stiffness of plates as a multiple of the contacts' `Kn`",
         {},
         true},
        {"plate_Kn",
         quantity(stiffness_gradient),
         words(usual_plate_Kn()),
         "stiffness of plates itself, in place of `plate_stiffness_factor`, as of bearing strips or of the tape on curved jaws "
         "([why](validation/brazilian-plates.md))",
         {},
         true},
        {"plate_mu", number(not_negative), words(usual_plate_mu()), "friction of plates", methods_that_are(takes_friction), true,
         ": its plates are glued on, or have a mu of their own"},
        {"membrane_plates", integer(1, 1000), usual(spec.membrane_plates),
         "plates of the membrane on each side; each must have a grain behind it", methods_that_are(confined), true},
    };
    std::ranges::move(further, std::back_inserter(keys));
    return keys;
}

std::vector<JobKey> until_keys() {
    return {
        {"gauge", text("the name of a gauge"), needed, "a gauge of the method or of the test"},
        {"at", quantity(length, any_value), needed,
         "the test ends when the gauge has reached this: a length, of a force gauge a force, of a stress gauge a stress, of an "
         "energy gauge an energy, of a strain gauge a fraction"},
    };
}

std::vector<JobKey> stage_keys() {
    const KeyCondition moving = with("kind", {StageForm::load, StageForm::unload}), hold = with("kind", {StageForm::hold}),
                       confine = with("kind", {StageForm::confine}), cycle = with("kind", {StageForm::cycle});
    const KeyValue value = quantity(fraction, any_value);  // the quantity decides
    return {
        {"kind", choice_of(stage_forms), needed,
         "`\"load\"`: the loading motion grows; `\"unload\"`: it goes back; `\"hold\"`: it is at rest; `\"confine\"`: the "
         "pressure on the sides changes; `\"cycle\"`: "
         "stages that are repeated"},
        {"until", stage_ends_and_gauges(), words("of the last loading the end of the test; of unloading a stress of 0"),
         "what ends it: `\"stress\"` or `\"load\"`, positive in the sense of the loading; `\"axial-strain\"`: loading motion "
         "over length; `\"lateral-strain\"`: less than 0 when the "
         "specimen widens; `\"share-of-peak\"`: the load has fallen to a share of the largest so far; `\"reversal\"`: the "
         "volumetric strain has turned; the name of a gauge",
         moving},
        {"at", value, words("`at`, `by` or `beyond` must be given, but for a reversal"),
         "... at this value: a stress, a force, a length, or a share such as `\"0.1 %\"`, as its quantity is", moving},
        {"by", value, words("none"), "... when it has changed by so much since the stage began", moving},
        {"beyond", value, words("none"),
         "... when it is so far beyond where the last loading ended; in the first loading as `by`", moving},
        {"travel_times", number(positive), words("until the specimen is at rest"),
         "how long, in times in which a wave crosses the specimen", hold},
        {"sigma3", quantity(stress, not_negative), must,
         "the pressure to which it goes, over 30 travel times if it changes altogether", confine},
        {"fixture", text("the name of a fixture"), words("all that press"), "whose pressure changes", confine},
        {"keep", choice_of(confine_keeps), words("`\"motion\"`"),
         "`\"motion\"`: the loading motion is at rest; `\"load\"`: it follows, so that the axial stress stays", confine},
        {"times", integer(1, 10000), words("until the test ends"), "how often", cycle},
        {"stages", tables("test.stages"), must, "the stages; not a cycle again", cycle},
    };
}

std::vector<JobKey> fixture_keys() {
    const auto forms = [](std::initializer_list<FixtureForm> some) { return with("kind", some); };
    const KeyCondition boundary = forms({FixtureForm::boundary}),
                       plates = forms({FixtureForm::plate, FixtureForm::roller, FixtureForm::jaw}),
                       curved = forms({FixtureForm::roller, FixtureForm::jaw}), pressure = forms({FixtureForm::pressure}),
                       flat = forms({FixtureForm::plate}), pressing = forms({FixtureForm::plate, FixtureForm::pressure}),
                       moving = forms({FixtureForm::boundary, FixtureForm::plate, FixtureForm::roller, FixtureForm::jaw});
    return {
        {"name", text("1 to 40 letters, digits, blanks, '_' and '-'"), needed, "of messages and of gauges that read its force"},
        {"kind", choice_of(fixture_forms), needed,
         "`\"boundary\"`: the nodes on a part of the boundary of flexible grains follow it; a rigid plate that the specimen is "
         "pressed against: flat, `\"roller\"` or hollow `\"jaw\"`; `\"pressure\"` on a part of the boundary of flexible grains"},
        {"on", text("the label of an edge"), words("`on` or `at` must be given"), "the part of the boundary with this label"},
        {"at", point(), words("`on` or `at` must be given"),
         "the part of the boundary near this point; of a roller or jaw the point where its surface touches"},
        {"within", quantity(length), words("of a roller or jaw its radius; else it must be given beside `at`"), "how near"},
        {"motion", direction(), words("at rest"), "x and y of its way per unit of the loading motion, such as `[0, -1]`", moving},
        {"normal", direction(), must, "x and y of the direction from the specimen into the plate", plates},
        {"radius", quantity(length), must, "radius of its surface", curved},
        {"Kn", quantity(stiffness_gradient), words("`plate_Kn` of the test"), "stiffness per area", plates},
        {"mu", number(not_negative), usual(0.0), "friction", plates},
        {"pressure", quantity(stress), words("of a plate: it does not give way"),
         "on the part of the boundary; of a plate, which then is free along its normal: the force on it over the area that it "
         "covers",
         pressing},
        {"force", quantity(Dimension::force), words("of a plate: it does not give way"),
         "the force on a plate that is free along its normal, in place of `pressure`", flat},
        {"spring", quantity(stiffness_gradient, not_negative), words("the pressure stays"),
         "by how much the pressure on such a plate grows as the specimen pushes it out", flat},
        {"glued", flag(), usual(0.0), "unbreakable along its normal, free along the plate", plates},
        {"holds_x", flag(), usual(1.0), "x follows the fixture; else it is free", boundary},
        {"holds_y", flag(), usual(1.0), "y follows the fixture; else it is free", boundary},
        {"pin", flag(), usual(0.0), "the node nearest to the middle of the part is held in the free component too", boundary},
    };
}

std::vector<JobKey> gauge_keys() {
    const KeyCondition between = with("kind", {GaugeForm::extension, GaugeForm::strain}),
                       means = with("kind", {GaugeForm::mean_stress, GaugeForm::mean_strain}),
                       round = with("kind", {GaugeForm::mean_stress, GaugeForm::mean_strain, GaugeForm::hole_stress});
    return {
        {"name", text("1 to 40 letters, digits, '_' and '-'"), needed,
         "its column in the results; `control` and `until` may name it"},
        {"kind", choice_of(gauge_forms), needed,
         "`\"extension\"`: by how much two points move apart; `\"strain\"`: the same over their distance; `\"displacement\"` of "
         "a point or a plate; `\"force\"` on a fixture; `\"mean-stress\"` and "
         "`\"mean-strain\"` in a region, and `\"hole-stress\"` along the edge of a round hole, compression positive; "
         "`\"energy\"` of the whole test "
         "([definitions](theory/properties.md))"},
        {"from", point(), must, "first point", between},
        {"to", point(), must, "second point", between},
        {"at", point(), words("`at` or `fixture` must be given"), "the point", with("kind", {GaugeForm::displacement})},
        {"fixture", text("the name of a fixture"), words("of a force it must be given"),
         "the fixture; of a displacement in place of `at`: a plate", with("kind", {GaugeForm::force, GaugeForm::displacement})},
        {"box", pairs_of(quantity(length, any_value), quantity(length, any_value)),
         words("`box`, or `centre` and `radius`, must be given"), "the region: a box, by two opposite corners", means},
        {"centre", point(), words("of a hole it must be given"), "centre of the region, a circle, or of the hole", round},
        {"radius", quantity(length), words("of a hole it must be given"), "radius of the region or of the hole", round},
        {"direction", direction(), must,
         "x and y of the direction in which it reads; of a hole: from its centre to the place on its edge",
         with("kind", {GaugeForm::displacement, GaugeForm::force, GaugeForm::mean_stress, GaugeForm::mean_strain,
                       GaugeForm::hole_stress})},
        {"normal", direction(), words("`direction`: a normal component"),
         "x and y of the normal of the plane on which the component along `direction` is read; one across `direction` gives a "
         "shear stress or strain",
         means},
        {"term", choice_of(energy_terms), must,
         "a term of the energy balance ([theory](theory/loading.md)); `\"supplied\"`: by the loading, `\"elastic\"`: in grains "
         "and contacts",
         with("kind", {GaugeForm::energy})},
    };
}

std::vector<JobKey> run_keys() {
    return {
        {"seeds", list_of(integer(0)), {.toml = "[1]"}, "one packing each"},
        {"seed", integer(0), words("1"), "in place of `seeds`: a single packing"},
        {"threads", integer(1, 256, {"auto"}), usual_word("auto"),
         "of the whole program; `\"auto\"`: one for each core that it may use"},
        {"at_once", integer(1, 256, {"auto"}), usual_word("auto"),
         "at most so many tests side by side, never more than threads; `\"auto\"`: as suits their size"},
    };
}

// What a laboratory reports, by the table of properties (lab/rock_properties.hpp), with the short names that papers use.
std::vector<JobKey> laboratory_keys() {
    const auto value_of = [](const RockProperty& property) {
        if (!property.unit.written) return number(property.name == "nu" ? poisson : positive);
        const Dimension dimension = *property.unit.written;
        KeyValue value = quantity(dimension, dimension == angle ? below_right_angle : positive);
        value.unit = property.unit.user;
        return value;
    };
    constexpr std::pair<std::string_view, std::string_view> short_names[]{
        {"cohesion", "c"}, {"friction_angle", "phi"}, {"hoek_brown_mi", "mi"}, {"sigma_ci_crack_volume", "sigma_ci"}};
    std::vector<JobKey> keys;
    for (const RockProperty& property : rock_properties()) {
        if (property.laboratory.empty() || !property.reported()) continue;
        keys.push_back({property.name, value_of(property), none, property.label});
        for (const auto& [name, alias] : short_names)
            if (name == property.name) {
                JobKey same{alias, value_of(property), none, fmt::format("the same as `{}`", name)};
                same.same_as = property.name;
                keys.push_back(std::move(same));
            }
    }
    keys.push_back({"confined", pairs_of(quantity(stress), quantity(stress)), none,
                    "strengths under confinement: pairs of \u03c3\u2083 and \u03c3\u2081, shown beside envelopes"});
    return keys;
}

std::vector<KeyTable> all_tables() {
    std::vector<KeyTable> tables{
        {"", "the file", file_keys()},
        {"specimen", "[specimen]", specimen_keys()},
        {"specimen.grains", "[specimen.grains]", grains_keys()},
        {"specimen.grains.diameter", "[specimen.grains] diameter", diameter_keys()},
        {"specimen.arcs", "[[specimen.arcs]]", arc_keys()},
        {"specimen.holes", "[[specimen.holes]]", hole_keys()},
        {"specimen.notches", "[[specimen.notches]]", notch_keys()},
        {"specimen.labels", "[[specimen.labels]]", label_keys()},
        {"model", "[model]", model_keys()},
        {"material", "[material]", material_keys()},
        {"material.grain", "[material.grain]", grain_keys()},
        {"material.contact", "[material.contact]", contact_keys()},
        {"material.phase", "[[material.phase]]", phase_keys()},
        {"material.pair", "[[material.pair]]", pair_keys()},
        {"material.crystal", "[material.crystal]", crystal_keys()},
        {"material.minerals", "[material.minerals]", minerals_keys()},
        {"material.scatter", "[material.scatter]", scatter_keys()},
        {"material.scatter.strength", "[material.scatter] strength, ...", distribution_keys()},
        {"material.initial_cracks", "[material.initial_cracks]", initial_cracks_keys()},
        {"material.joint", "[[material.joint]]", joint_keys()},
        {"material.joint.set", "[[material.joint]] set", joint_set_keys()},
        {"numerics", "[numerics]", numerics_keys()},
        {"variant", "[[variant]]", variant_keys()},
        {"test", "[[test]]", test_keys()},
        {"test.specimen", "[test.specimen]", outline_rows()},
        {"test.until", "[test.until]", until_keys()},
        {"test.stages", "[[test.stages]]", stage_keys()},
        {"test.fixture", "[[test.fixture]]", fixture_keys()},
        {"test.gauge", "[[test.gauge]]", gauge_keys()},
        {"run", "[run]", run_keys()},
        {"laboratory", "[laboratory]", laboratory_keys()},
    };
    // a table means what the first key means behind which it stands
    for (KeyTable& table : tables)
        for (const KeyTable& outer : tables)
            for (const JobKey& key : outer.keys)
                if (key.value.element.form == ValueForm::table && key.value.element.table == table.path && table.meaning.empty())
                    table.meaning = key.meaning;
    return tables;
}

}  // namespace

std::vector<std::string_view> KeyTable::names() const {
    std::vector<std::string_view> found;
    for (const JobKey& key : keys) found.push_back(key.name);
    return found;
}

const JobKey& KeyTable::key(std::string_view name) const {
    const auto found = std::ranges::find(keys, name, &JobKey::name);
    if (found == keys.end()) throw std::logic_error(fmt::format("job/keys.cpp has no key '{}' of {}", name, head));
    return *found;
}

std::span<const KeyTable> job_tables() {
    static const std::vector<KeyTable> all = all_tables();
    return all;
}

const KeyTable& job_table(std::string_view path) {
    const std::span<const KeyTable> all = job_tables();
    const auto found = std::ranges::find(all, path, &KeyTable::path);
    if (found == all.end()) throw std::logic_error(fmt::format("job/keys.cpp has no table '{}'", path));
    return *found;
}

const JobKey& job_key(std::string_view path, std::string_view name) { return job_table(path).key(name); }

bool KeyCondition::holds(std::string_view word) const { return std::ranges::find(words, word) != words.end(); }

}  // namespace feldspar
