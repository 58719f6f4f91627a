// One variant's physics: its own tables lie over the job's, and each over the presets that it names.
#include <algorithm>
#include <array>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/presets.hpp"

namespace feldspar {
namespace {

const Range poisson_range{-1.0, 0.5, false, false, "greater than -1 and less than 0.5"};

constexpr auto model_keys = std::to_array<std::string_view>({"kind", "contact", "normal", "plane"});
constexpr auto material_keys = std::to_array<std::string_view>({"elastic_preset", "strength_preset", "grain", "contact"});
constexpr auto grain_keys = std::to_array<std::string_view>({"E", "nu", "density"});
constexpr auto contact_keys = std::to_array<std::string_view>(
    {"law", "Kn", "eta", "kratio", "sigma_nt", "tau", "mu", "Gfn", "Gfs", "shear_measure", "tension_unloading"});
constexpr auto laboratory_keys = std::to_array<std::string_view>(
    {"E", "nu", "UCS", "DTS", "BTS", "cohesion", "c", "friction_angle", "phi", "hoek_brown_mi", "mi", "confined"});
constexpr auto numerics_keys = std::to_array<std::string_view>(
    {"kind", "accuracy", "residual_target", "damping", "speed", "mass_factor", "time_step", "maximum_steps", "confirm"});

using Layers = std::vector<TableReader>;

// The table `key` of every holder that has it.
Layers tables_of(const Layers& holders, std::string_view key, std::span<const std::string_view> known) {
    Layers found;
    for (const TableReader& holder : holders)
        if (holder.has(key)) found.push_back(holder.table(key, known));
    return found;
}

// One table that looks through all layers, or nothing.
std::optional<TableReader> laid_over(Layers layers) {
    std::stable_sort(layers.begin(), layers.end(),
                     [](const TableReader& a, const TableReader& b) { return a.level() > b.level(); });
    std::optional<TableReader> whole;
    for (const TableReader& layer : layers) whole = whole ? layer.over(*whole) : layer;
    return whole;
}

std::string kind_setting(GrainKind kind) { return std::string("kind = \"") + name(kind) + "\""; }

// The model, and the level of the table that chose its kind: what lies deeper and does not suit it is put aside.
struct ReadModel {
    ModelSpec model;
    int decided_at = not_given;
    bool known = true;   // false: its kind could not be read, so nothing is held against it
};

void refuse_value(const TableReader& table, std::string_view key, const ReadModel& read, const std::string& why,
                  const std::string& allowed) {
    if (table.level_of(key) > read.decided_at || !table.has(key)) return;
    table.check({key}, [&] { table.fail(key, shown(*table.find(key)) + " does not apply to " + kind_setting(read.model.kind) + why, allowed); });
}

void suit_contact(const TableReader& table, ReadModel& read) {
    if (read.model.kind != GrainKind::inner_particles) return;
    if (read.model.contact == ContactKind::lobatto3)
        refuse_value(table, "contact", read, ": particles touch at one point", "\"point\", or leave it out");
    read.model.contact = ContactKind::point;
}

void suit_normal(const TableReader& table, ReadModel& read) {
    if (read.model.kind == GrainKind::inner_particles || read.model.normal == ContactNormal::centres) return;
    refuse_value(table, "normal", read, "", "\"centres\"; \"edge\" belongs to kind = \"inner-particles\"");
    read.model.normal = ContactNormal::centres;
}

void suit_plane(const TableReader& table, ReadModel& read) {
    if (read.model.kind == GrainKind::flexible || read.model.plane == PlaneState::stress) return;
    refuse_value(table, "plane", read, ": a two-dimensional assembly without elastic constants knows no plane state",
                 "leave it out; \"strain\" belongs to kind = \"flexible\"");
    read.model.plane = PlaneState::stress;
}

ReadModel read_model(const Layers& holders) {
    ReadModel read;
    read.known = std::all_of(holders.begin(), holders.end(), [](const TableReader& holder) { return holder.sound({"model.kind"}); });
    const std::optional<TableReader> found = laid_over(tables_of(holders, "model", model_keys));
    if (!found) return read;
    const TableReader& table = *found;
    ModelSpec& model = read.model;
    model.kind = table.choice("kind", grain_kinds, {model.kind});
    read.decided_at = table.level_of("kind");
    model.contact = table.choice("contact", contact_kinds, {model.contact});
    model.normal = table.choice("normal", contact_normals, {model.normal});
    model.plane = table.choice("plane", plane_states, {model.plane});
    read.known = read.known && table.sound({"kind"});
    if (!read.known) return read;
    suit_contact(table, read);
    suit_normal(table, read);
    suit_plane(table, read);
    return read;
}

// Nothing if there is none of that name.
const Preset* preset_of(const TableReader& material, std::string_view key, std::span<const Preset> presets) {
    const std::string given = material.text(key);
    std::vector<std::string_view> names;
    for (const Preset& preset : presets) {
        if (preset.name == given) return &preset;
        names.push_back(preset.name);
    }
    material.check({key}, [&] { material.fail(key, "'" + given + "' is not a preset", listed(names), did_you_mean(given, names)); });
    return nullptr;
}

// A preset fitted for other grains would give them the wrong stiffness without a word.
void check_kind(const TableReader& material, const Preset& preset, GrainKind kind) {
    if (!preset.kind || *preset.kind == kind) return;
    std::vector<std::string_view> right;
    for (const Preset& other : elastic_presets())
        if (other.kind == kind) right.push_back(other.name);
    material.fail(
        "elastic_preset",
        "'" + std::string(preset.name) + "' is for " + kind_setting(*preset.kind) + ", but here it meets " + kind_setting(kind),
        listed(right));
}

// The presets that hold for this variant, as layers under the tables that name them.
struct MaterialTables {
    TableReader all;                     // [material]
    std::optional<TableReader> grain;    // [material.grain] over presets
    std::optional<TableReader> contact;  // [material.contact] over presets
};

bool all_sound(const Layers& holders, const std::string& key) {
    return std::all_of(holders.begin(), holders.end(), [&](const TableReader& holder) { return holder.sound({key}); });
}

MaterialTables material_tables(const Layers& holders, const ReadModel& model) {
    Layers materials = tables_of(holders, "material", material_keys);
    if (materials.empty()) materials.push_back((holders.back().sound({"material"}) ? holders.front() : holders.back()).table("material", material_keys));
    MaterialTables result{*laid_over(materials), {}, {}};
    Layers grains = tables_of(materials, "grain", grain_keys), contacts = tables_of(materials, "contact", contact_keys);
    bool presets_known = true;
    const auto add_preset = [&](std::string_view key, std::span<const Preset> presets) {
        const bool known = all_sound(holders, "material." + std::string(key));   // else a table above may name another one
        presets_known = presets_known && known;
        if (!result.all.has(key) || !known) return;
        const Preset* preset = preset_of(result.all, key, presets);
        if (preset != nullptr && model.known) result.all.check({key}, [&] { check_kind(result.all, *preset, model.model.kind); });
        if (preset == nullptr || !result.all.sound({key})) {
            presets_known = false;
            return;
        }
        const TableReader table =
            TableReader(preset_table(*preset), "material", result.all.file(), {"grain", "contact"}, result.all.level_of(key) + 1,
                        result.all.mistakes())
                .placed_at(*result.all.find(key));
        if (table.has("grain")) grains.push_back(table.table("grain", grain_keys));
        if (table.has("contact")) contacts.push_back(table.table("contact", contact_keys));
    };
    add_preset("elastic_preset", elastic_presets());
    add_preset("strength_preset", strength_presets());
    result.grain = laid_over(grains);
    result.contact = laid_over(contacts);
    // what is not there may be in a preset or a table that could not be read
    if (!presets_known || !all_sound(holders, "material.grain")) {
        result.all.do_not_miss({"grain"});
        if (result.grain) result.grain->do_not_miss(grain_keys);
    }
    if (!presets_known || !all_sound(holders, "material.contact")) {
        result.all.do_not_miss({"contact"});
        if (result.contact) result.contact->do_not_miss(contact_keys);
    }
    return result;
}

GrainMaterial read_grain(const MaterialTables& material, const ReadModel& read) {
    GrainMaterial grain;
    const bool flexible = read.model.kind == GrainKind::flexible || !read.known;
    if (flexible && read.known && !material.grain) material.all.require({"grain"});
    if (!material.grain) return grain;
    const TableReader& table = *material.grain;
    grain.density_kg_m3 = table.quantity("density", Dimension::density, positive, grain.density_kg_m3);
    if (!flexible) {
        table.refuse({"E", "nu"}, kind_setting(read.model.kind) + ": these grains have no elastic constants",
                     "density; the specimen deforms by Kn and eta of its contacts", read.decided_at);
        return grain;
    }
    if (!read.known) table.do_not_miss({"E", "nu"});
    table.require({"E", "nu"});
    grain.E_Pa = table.quantity("E", Dimension::stress, positive);
    Range range = poisson_range;
    if (read.model.plane == PlaneState::strain)
        range.words = "greater than -1 and less than 0.5 (at 0.5 the stiffness in plane strain is infinite)";
    grain.nu = table.number("nu", range);
    return grain;
}

// ks / kn, given itself or as its inverse; of two tables the upper one counts.
double read_eta(const TableReader& table) {
    table.check({"eta", "kratio"}, [&] {
        if (!table.has("eta") && !table.has("kratio")) table.fail("eta", "missing key: eta", "eta = ks/kn, or kratio = kn/ks");
        if (table.has("eta") && table.level_of("eta") == table.level_of("kratio"))
            table.fail("kratio", "given beside eta, of which it is the inverse", "either eta = ks/kn or kratio = kn/ks");
    });
    if (!table.has("eta") && !table.has("kratio")) return 1.0;   // a mistake that is noted
    const bool inverse = table.level_of("kratio") < table.level_of("eta");
    return inverse ? 1.0 / table.number("kratio", positive) : table.number("eta", positive);
}

void read_softening(const TableReader& table, ContactMaterial& contact) {
    contact.Gfn_J_m2 = table.quantity("Gfn", Dimension::fracture_energy, positive);
    contact.Gfs_J_m2 = table.quantity("Gfs", Dimension::fracture_energy, positive);
    contact.shear_measure = table.choice<ShearMeasure>(
        "shear_measure", {{"total", ShearMeasure::total}, {"beyond-friction", ShearMeasure::beyond_friction}},
        contact.shear_measure);
    contact.tension_unloading = table.choice<TensionUnloading>(
        "tension_unloading", {{"elastic", TensionUnloading::elastic}, {"secant", TensionUnloading::secant}},
        contact.tension_unloading);
}

ContactMaterial read_contact(const MaterialTables& material) {
    ContactMaterial contact;
    if (!material.contact) {
        material.all.require({"contact"});
        return contact;
    }
    const TableReader& table = *material.contact;
    contact.law = table.choice("law", contact_laws, {contact.law});
    if (!table.sound({"law"})) table.do_not_miss({"Gfn", "Gfs"});
    const bool softens = contact.law != ContactLaw::brittle || !table.sound({"law"});
    if (softens) {
        table.require({"Kn", "sigma_nt", "tau", "mu", "Gfn", "Gfs"});
    } else {
        table.refuse({"Gfn", "Gfs", "shear_measure", "tension_unloading"}, "law = \"brittle\", which does not soften", {},
                     table.level_of("law"));
        table.require({"Kn", "sigma_nt", "tau", "mu"});
    }
    contact.Kn_Pa_m = table.quantity("Kn", Dimension::stiffness_gradient, positive);
    contact.eta = read_eta(table);
    contact.sigma_nt_Pa = table.quantity("sigma_nt", Dimension::stress, positive);
    contact.tau_Pa = table.quantity("tau", Dimension::stress, positive);
    contact.mu = table.number("mu", not_negative);
    if (softens) read_softening(table, contact);
    return contact;
}

void refuse_other_numerics(const TableReader& table, NumericsKind kind) {
    if (!table.sound({"kind"})) return;
    const int decided_at = table.level_of("kind");
    switch (kind) {
        case NumericsKind::adaptive:
            table.refuse({"speed"}, "kind = \"adaptive\", which finds its own speed",
                         "accuracy; or kind = \"paper\" or \"dynamic\" with a speed", decided_at);
            table.refuse({"time_step"}, "kind = \"adaptive\"",
                         "accuracy, residual_target, damping, mass_factor, maximum_steps, confirm", decided_at);
            break;
        case NumericsKind::paper:
            table.refuse({"accuracy", "residual_target", "time_step"}, "kind = \"paper\"",
                         "damping, speed, mass_factor, maximum_steps, confirm", decided_at);
            break;
        case NumericsKind::dynamic:
            table.refuse({"accuracy", "residual_target", "mass_factor"}, "kind = \"dynamic\"",
                         "damping, speed, time_step, maximum_steps, confirm", decided_at);
            table.require({"speed"});
            break;
    }
}

void read_accuracy(const TableReader& table, NumericsSpec& numerics) {
    const bool target = table.has("residual_target");
    if (target && table.level_of("accuracy") == table.level_of("residual_target"))
        table.check({}, [&] { table.fail("residual_target", "given beside accuracy, which it would override", "one of the two"); });
    if (target && table.level_of("residual_target") < table.level_of("accuracy")) {
        numerics.residual_target = table.number("residual_target", {0.0, 0.5, false, true, "greater than 0, at most 0.5"});
        return;
    }
    // a hair wider than stated, for 0.05 % is not the same double as 0.0005
    const Range accuracy{0.0005 * (1.0 - 1e-12), 0.1 * (1.0 + 1e-12), true, true, "from 0.05 % to 10 %"};
    numerics.accuracy = table.fraction("accuracy", accuracy, numerics.accuracy);
}

NumericsSpec read_numerics(const std::optional<TableReader>& found) {
    NumericsSpec numerics;
    if (!found) return numerics;
    const TableReader& table = *found;
    numerics.kind = table.choice("kind", numerics_kinds, {numerics.kind});
    refuse_other_numerics(table, numerics.kind);
    const bool adaptive = numerics.kind == NumericsKind::adaptive, dynamic = numerics.kind == NumericsKind::dynamic;
    if (adaptive) read_accuracy(table, numerics);
    numerics.damping = table.number("damping", {0.0, 1.0, true, false, "0 or greater and less than 1"}, numerics.damping);
    if (!adaptive && table.has("speed"))
        numerics.speed_m = table.quantity("speed", dynamic ? Dimension::speed : Dimension::speed_per_step, positive);
    if (!dynamic && table.has("mass_factor")) numerics.mass_factor = table.number("mass_factor", positive);
    if (dynamic && table.has("time_step")) numerics.time_step_s = table.quantity("time_step", Dimension::time, positive);
    if (table.has("maximum_steps"))
        numerics.maximum_steps = table.integer("maximum_steps", 1, std::numeric_limits<long long>::max());
    numerics.confirm = table.flag("confirm", numerics.confirm);
    return numerics;
}

}  // namespace

Physics read_physics(const TableReader& root, const TableReader* variant) {
    Layers holders;
    if (variant != nullptr) holders.push_back(*variant);
    holders.push_back(root);
    const ReadModel model = read_model(holders);
    const MaterialTables material = material_tables(holders, model);
    Physics physics;
    physics.model = model.model;
    physics.grain = read_grain(material, model);
    physics.contact = read_contact(material);
    physics.numerics = read_numerics(laid_over(tables_of(holders, "numerics", numerics_keys)));
    return physics;
}

std::map<std::string, double> read_laboratory(const TableReader& root) {
    std::map<std::string, double> values;
    if (!root.has("laboratory")) return values;
    const TableReader table = root.table("laboratory", laboratory_keys);
    const auto one_of = [&](std::string_view name, std::string_view alias) {
        if (table.has(name) && table.has(alias))
            table.check({}, [&] { table.fail(alias, "given beside " + std::string(name) + ", which is the same", "one of the two"); });
        return table.has(alias) ? alias : name;
    };
    for (const char* name : {"E", "UCS", "DTS", "BTS"})
        if (table.has(name)) values[name] = table.quantity(name, Dimension::stress, positive);
    if (table.has("nu")) values["nu"] = table.number("nu", poisson_range);
    if (const auto key = one_of("cohesion", "c"); table.has(key))
        values["cohesion"] = table.quantity(key, Dimension::stress, positive);
    const Range angle{0.0, 0.5 * 3.14159265358979323846, true, false, "from 0 to less than 90 deg"};
    if (const auto key = one_of("friction_angle", "phi"); table.has(key))
        values["friction_angle"] = table.quantity(key, Dimension::angle, angle);
    if (const auto key = one_of("hoek_brown_mi", "mi"); table.has(key)) values["hoek_brown_mi"] = table.number(key, positive);
    return values;
}

std::vector<ConfinedStrength> read_laboratory_confined(const TableReader& root) {
    std::vector<ConfinedStrength> strengths;
    if (!root.has("laboratory")) return strengths;
    const TableReader table = root.table("laboratory", laboratory_keys);
    if (!table.has("confined")) return strengths;
    for (const toml::node& node : table.array("confined"))
        table.check({}, [&] {
            const toml::array* pair = node.as_array();
            if (pair == nullptr || pair->size() != 2)
                table.fail_at(node, "confined", shown(node) + " is not a strength under confinement", "pairs of sigma_3 and sigma_1: [[\"4 MPa\", \"150 MPa\"], ...]");
            const ConfinedStrength strength{table.quantity_of(*pair->get(0), "confined", Dimension::stress, positive),
                                            table.quantity_of(*pair->get(1), "confined", Dimension::stress, positive)};
            if (strength.sigma1_Pa <= strength.sigma3_Pa) table.fail_at(node, "confined", "sigma_1 is not larger than sigma_3", "sigma_3 first, then sigma_1");
            strengths.push_back(strength);
        });
    return strengths;
}

}  // namespace feldspar
