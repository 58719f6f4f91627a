// One variant's physics: its own tables lie over the job's, and each over the presets that it names.
#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/presets.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/model/texture.hpp"

namespace feldspar {
namespace {

using Layers = std::vector<JobTable>;

// The table `key` of every holder that has it.
Layers tables_of(const Layers& holders, std::string_view key) {
    Layers found;
    for (const JobTable& holder : holders)
        if (holder.has(key)) found.push_back(holder.table(key));
    return found;
}

// One table that looks through all layers, or nothing.
std::optional<JobTable> laid_over(Layers layers) {
    std::stable_sort(layers.begin(), layers.end(), [](const JobTable& a, const JobTable& b) { return a.level() > b.level(); });
    std::optional<JobTable> whole;
    for (const JobTable& layer : layers) whole = whole ? layer.over(*whole) : layer;
    return whole;
}

std::string kind_setting(GrainKind kind) { return std::string("kind = \"") + name(kind) + "\""; }

// The model, and the level of the table that chose its kind: what lies deeper and does not suit it is put aside.
struct ReadModel {
    ModelSpec model;
    int decided_at = not_given;
    bool known = true;  // false: its kind could not be read, so nothing is held against it
};

void refuse_value(const JobTable& table, std::string_view key, const ReadModel& read, const std::string& why,
                  const std::string& allowed) {
    if (table.level_of(key) > read.decided_at || !table.has(key)) return;
    table.check({key}, [&] {
        table.fail(key, shown(*table.find(key)) + " does not apply to " + kind_setting(read.model.kind) + why, allowed);
    });
}

void suit_contact(const JobTable& table, ReadModel& read) {
    if (read.model.kind != GrainKind::inner_particles) return;
    if (read.model.contact == ContactKind::lobatto3)
        refuse_value(table, "contact", read, ": particles touch at one point", "\"point\", or leave it out");
    read.model.contact = ContactKind::point;
}

void suit_normal(const JobTable& table, ReadModel& read) {
    if (read.model.kind == GrainKind::inner_particles || read.model.normal == ContactNormal::centres) return;
    refuse_value(table, "normal", read, "", "\"centres\"; \"edge\" belongs to kind = \"inner-particles\"");
    read.model.normal = ContactNormal::centres;
}

void suit_plane(const JobTable& table, ReadModel& read) {
    if (read.model.kind == GrainKind::flexible || read.model.plane == PlaneState::stress) return;
    refuse_value(table, "plane", read, ": a two-dimensional assembly without elastic constants knows no plane state",
                 "leave it out; \"strain\" belongs to kind = \"flexible\"");
    read.model.plane = PlaneState::stress;
}

ReadModel read_model(const Layers& holders) {
    ReadModel read;
    read.known = std::all_of(holders.begin(), holders.end(), [](const JobTable& holder) { return holder.sound({"model.kind"}); });
    const std::optional<JobTable> found = laid_over(tables_of(holders, "model"));
    if (!found) return read;
    const JobTable& table = *found;
    ModelSpec& model = read.model;
    model.kind = table.choice("kind", grain_kinds);
    read.decided_at = table.level_of("kind");
    model.contact = table.choice("contact", contact_kinds);
    model.normal = table.choice("normal", contact_normals);
    model.plane = table.choice("plane", plane_states);
    read.known = read.known && table.sound({"kind"});
    if (!read.known) return read;
    suit_contact(table, read);
    suit_normal(table, read);
    suit_plane(table, read);
    return read;
}

// Nothing if there is none of that name.
const Preset* preset_of(const JobTable& material, std::string_view key, std::span<const Preset> presets) {
    const std::string given = material.text(key);
    std::vector<std::string_view> names;
    for (const Preset& preset : presets) {
        if (preset.name == given) return &preset;
        names.push_back(preset.name);
    }
    material.check({key},
                   [&] { material.fail(key, "'" + given + "' is not a preset", listed(names), did_you_mean(given, names)); });
    return nullptr;
}

// A preset fitted for other grains would give them the wrong stiffness without a word.
void check_kind(const JobTable& material, const Preset& preset, GrainKind kind) {
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
    JobTable all;                     // [material]
    std::optional<JobTable> grain;    // [material.grain] over presets
    std::optional<JobTable> contact;  // [material.contact] over presets
};

bool all_sound(const Layers& holders, const std::string& key) {
    return std::all_of(holders.begin(), holders.end(), [&](const JobTable& holder) { return holder.sound({key}); });
}

MaterialTables material_tables(const Layers& holders, const ReadModel& model) {
    Layers materials = tables_of(holders, "material");
    if (materials.empty())
        materials.push_back((holders.back().sound({"material"}) ? holders.front() : holders.back()).table("material"));
    MaterialTables result{*laid_over(materials), {}, {}};
    Layers grains = tables_of(materials, "grain"), contacts = tables_of(materials, "contact");
    bool presets_known = true;
    const auto add_preset = [&](std::string_view key, std::span<const Preset> presets) {
        const bool known = all_sound(holders, "material." + std::string(key));  // else a table above may name another one
        presets_known = presets_known && known;
        if (!result.all.has(key) || !known) return;
        const Preset* preset = preset_of(result.all, key, presets);
        if (preset != nullptr && model.known) result.all.check({key}, [&] { check_kind(result.all, *preset, model.model.kind); });
        if (preset == nullptr || !result.all.sound({key})) {
            presets_known = false;
            return;
        }
        const TableReader keys(preset_table(*preset), "material", result.all.file(), result.all.rows().names(),
                               result.all.level_of(key) + 1, result.all.mistakes());
        const JobTable table(keys.placed_at(*result.all.find(key)), result.all.rows());
        if (table.has("grain")) grains.push_back(table.table("grain"));
        if (table.has("contact")) contacts.push_back(table.table("contact"));
    };
    add_preset("elastic_preset", elastic_presets());
    add_preset("strength_preset", strength_presets());
    result.grain = laid_over(grains);
    result.contact = laid_over(contacts);
    // what is not there may be in a preset or a table that could not be read
    if (!presets_known || !all_sound(holders, "material.grain")) {
        result.all.do_not_miss({"grain"});
        if (result.grain) result.grain->do_not_miss(result.grain->rows().names());
    }
    if (!presets_known || !all_sound(holders, "material.contact")) {
        result.all.do_not_miss({"contact"});
        if (result.contact) result.contact->do_not_miss(result.contact->rows().names());
    }
    return result;
}

GrainMaterial read_grain(const MaterialTables& material, const ReadModel& read) {
    GrainMaterial grain;
    const bool flexible = read.model.kind == GrainKind::flexible || !read.known;
    const bool minerals = material.all.has("phase");  // which may give it all
    if (minerals) grain.nu = std::numeric_limits<double>::quiet_NaN();
    if (flexible && read.known && !material.grain && !minerals) material.all.require({"grain"});
    if (!material.grain) return grain;
    const JobTable& table = *material.grain;
    grain.density_kg_m3 = table.quantity("density");
    if (!read.known || minerals)
        table.do_not_miss({"E", "nu"});
    else
        table.suit("model.kind", name(read.model.kind), read.decided_at);
    if (!flexible) return grain;
    if (minerals && !table.has("E")) return grain;
    grain.E_Pa = table.quantity("E");
    if (minerals && !table.has("nu")) return grain;
    Range range = table.rows().key("nu").value.element.range;
    if (read.model.plane == PlaneState::strain)
        range.words = "greater than -1 and less than 0.5 (at 0.5 the stiffness in plane strain is infinite)";
    grain.nu = table.TableReader::number("nu", range);
    return grain;
}

// ks / kn, given itself or as its inverse; of two tables the upper one counts.
double read_eta(const JobTable& table) {
    table.check({"eta", "kratio"}, [&] {
        if (!table.has("eta") && !table.has("kratio")) table.fail("eta", "missing key: eta", "eta = ks/kn, or kratio = kn/ks");
        if (table.has("eta") && table.level_of("eta") == table.level_of("kratio"))
            table.fail("kratio", "given beside eta, of which it is the inverse", "either eta = ks/kn or kratio = kn/ks");
    });
    if (!table.has("eta") && !table.has("kratio")) return 1.0;  // a mistake that is noted
    const bool inverse = table.level_of("kratio") < table.level_of("eta");
    return inverse ? 1.0 / table.number("kratio") : table.number("eta");
}

}  // namespace

std::optional<double> read_friction(const JobTable& table) {
    table.check({"mu", "phi"}, [&] {
        if (table.has("mu") && table.level_of("mu") == table.level_of("phi"))
            table.fail("phi", "given beside mu, of which it is the angle", "either mu or phi = arctan mu");
    });
    if (!table.has("mu") && !table.has("phi")) return std::nullopt;
    return table.level_of("phi") < table.level_of("mu") ? std::tan(table.quantity("phi")) : table.number("mu");
}

namespace {

void read_softening(const JobTable& table, ContactMaterial& contact) {
    contact.Gfn_J_m2 = table.quantity("Gfn");
    contact.Gfs_J_m2 = table.quantity("Gfs");
    contact.shear_measure = table.choice("shear_measure", shear_measures);
    contact.tension_unloading = table.choice("tension_unloading", tension_unloadings);
}

ContactMaterial read_contact(const MaterialTables& material) {
    ContactMaterial contact;
    if (!material.contact) {
        material.all.require({"contact"});
        return contact;
    }
    const JobTable& table = *material.contact;
    contact.law = table.choice("law", contact_laws);
    const bool known = table.sound({"law"}), softens = contact.law != ContactLaw::brittle || !known;
    if (!known) table.do_not_miss({"Gfn", "Gfs"});
    table.suit("law", known ? name(contact.law) : "", table.level_of("law"));
    contact.Kn_Pa_m = table.quantity("Kn");
    contact.eta = read_eta(table);
    contact.sigma_nt_Pa = table.quantity("sigma_nt");
    contact.tau_Pa = table.quantity("tau");
    const std::optional<double> mu = read_friction(table);
    table.check({"mu", "phi"}, [&] {
        if (!mu) table.fail("mu", "missing key: mu", "mu, or the friction angle phi");
    });
    contact.mu = mu.value_or(0.0);
    if (softens) read_softening(table, contact);
    return contact;
}

void read_accuracy(const JobTable& table, NumericsSpec& numerics) {
    const bool target = table.has("residual_target");
    if (target && table.level_of("accuracy") == table.level_of("residual_target"))
        table.check({},
                    [&] { table.fail("residual_target", "given beside accuracy, which it would override", "one of the two"); });
    if (target && table.level_of("residual_target") < table.level_of("accuracy")) {
        numerics.residual_target = table.number("residual_target");
        return;
    }
    numerics.accuracy = table.fraction("accuracy");
}

NumericsSpec read_numerics(const std::optional<JobTable>& found) {
    NumericsSpec numerics;
    if (!found) return numerics;
    const JobTable& table = *found;
    numerics.kind = table.choice("kind", numerics_kinds);
    if (table.sound({"kind"})) {
        table.suit("kind", name(numerics.kind), table.level_of("kind"));
        if (numerics.kind == NumericsKind::dynamic) table.require({"speed"});
    }
    const bool adaptive = numerics.kind == NumericsKind::adaptive, dynamic = numerics.kind == NumericsKind::dynamic;
    if (adaptive) read_accuracy(table, numerics);
    numerics.damping = table.number("damping");
    if (!adaptive && table.has("speed"))
        numerics.speed_m = table.quantity_as("speed", dynamic ? Dimension::speed : Dimension::speed_per_step);
    if (!dynamic && table.has("mass_factor")) numerics.mass_factor = table.number("mass_factor");
    if (dynamic && table.has("time_step")) numerics.time_step_s = table.quantity("time_step");
    if (table.has("maximum_steps")) numerics.maximum_steps = table.integer("maximum_steps");
    numerics.confirm = table.flag("confirm");
    return numerics;
}

}  // namespace

Physics read_physics(const JobTable& root, const JobTable* variant) {
    Layers holders;
    if (variant != nullptr) holders.push_back(*variant);
    holders.push_back(root);
    const ReadModel model = read_model(holders);
    const MaterialTables material = material_tables(holders, model);
    Physics physics;
    physics.model = model.model;
    physics.grain = read_grain(material, model);
    physics.contact = read_contact(material);
    physics.rock = read_rock(material.all, model.model, model.known, model.decided_at, physics.grain, physics.contact);
    physics.grain = mean_grain(physics.rock.minerals, physics.grain);
    physics.numerics = read_numerics(laid_over(tables_of(holders, "numerics")));
    return physics;
}

std::map<std::string, double> read_laboratory(const JobTable& root) {
    std::map<std::string, double> values;
    if (!root.has("laboratory")) return values;
    const JobTable table = root.table("laboratory");
    for (const JobKey& key : table.rows().keys) {
        if (!table.has(key.name) || key.value.shape != ValueShape::one) continue;
        const std::string_view property = key.same_as.empty() ? key.name : key.same_as;
        if (property != key.name && table.has(property)) {
            table.check({}, [&] {
                table.fail(key.name, "given beside " + std::string(property) + ", which is the same", "one of the two");
            });
            continue;
        }
        values[std::string(property)] =
            key.value.element.form == ValueForm::quantity ? table.quantity(key.name) : table.number(key.name);
    }
    return values;
}

std::vector<ConfinedStrength> read_laboratory_confined(const JobTable& root) {
    std::vector<ConfinedStrength> strengths;
    if (!root.has("laboratory")) return strengths;
    const JobTable table = root.table("laboratory");
    if (!table.has("confined")) return strengths;
    table.pairs("confined", "a strength under confinement", "pairs of sigma_3 and sigma_1: [[\"4 MPa\", \"150 MPa\"], ...]",
                [&](const toml::node& sigma3, const toml::node& sigma1) {
                    const ConfinedStrength strength{table.first_of(sigma3, "confined"), table.second_of(sigma1, "confined")};
                    if (strength.sigma1_Pa <= strength.sigma3_Pa)
                        table.fail_at(sigma1, "confined", "sigma_1 is not larger than sigma_3", "sigma_3 first, then sigma_1");
                    strengths.push_back(strength);
                });
    return strengths;
}

}  // namespace feldspar
