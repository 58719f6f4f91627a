#include <algorithm>

#include "feldspar/study/job_sections.hpp"

namespace feldspar {
namespace {

enum class AnyGrainKind { flexible, rigid, inner_particles };

const Range poisson_range{-1.0, 0.5, false, false, "greater than -1 and less than 0.5"};

}  // namespace

ModelSpec read_model(const TableReader& root) {
    ModelSpec model;
    if (!root.has("model")) return model;
    const TableReader table = root.table("model", {"kind", "contact", "normal", "plane"});
    const auto kind = table.choice<AnyGrainKind>("kind",
                                                 {{"flexible", AnyGrainKind::flexible},
                                                  {"rigid", AnyGrainKind::rigid},
                                                  {"inner-particles", AnyGrainKind::inner_particles}},
                                                 AnyGrainKind::flexible);
    if (kind != AnyGrainKind::flexible)
        table.fail("kind", shown(*table.find("kind")) + " is not available yet in this version", "flexible");
    model.contact =
        table.choice<ContactKind>("contact", {{"lobatto3", ContactKind::lobatto3}, {"point", ContactKind::point}}, model.contact);
    model.plane =
        table.choice<PlaneState>("plane", {{"stress", PlaneState::stress}, {"strain", PlaneState::strain}}, model.plane);
    const bool edge = table.choice<bool>("normal", {{"centres", false}, {"edge", true}}, false);
    if (edge)
        table.fail("normal", "'edge' belongs to kind = \"inner-particles\", which is not available yet in this version",
                   "centres");
    return model;
}

GrainMaterial read_grain_material(const TableReader& material, const ModelSpec& model) {
    const TableReader table = material.table("grain", {"E", "nu", "density"});
    table.require({"E", "nu"});
    GrainMaterial grain;
    grain.E_Pa = table.quantity("E", Dimension::stress, positive);
    Range range = poisson_range;
    if (model.plane == PlaneState::strain)
        range.words = "greater than -1 and less than 0.5 (at 0.5 the stiffness in plane strain is infinite)";
    grain.nu = table.number("nu", range);
    grain.density_kg_m3 = table.quantity("density", Dimension::density, positive, grain.density_kg_m3);
    return grain;
}

ContactMaterial read_contact_material(const TableReader& material) {
    const TableReader table = material.table(
        "contact", {"law", "Kn", "eta", "kratio", "sigma_nt", "tau", "mu", "Gfn", "Gfs", "shear_measure", "tension_unloading"});
    ContactMaterial contact;
    contact.law = table.choice<ContactLaw>("law",
                                           {{"bilinear", ContactLaw::bilinear},
                                            {"bilinear-literal", ContactLaw::bilinear_literal},
                                            {"linear", ContactLaw::linear},
                                            {"brittle", ContactLaw::brittle}},
                                           contact.law);
    const bool softens = contact.law != ContactLaw::brittle;
    if (softens) {
        table.require({"Kn", "sigma_nt", "tau", "mu", "Gfn", "Gfs"});
    } else {
        table.refuse({"Gfn", "Gfs", "shear_measure", "tension_unloading"}, "law = \"brittle\", which does not soften");
        table.require({"Kn", "sigma_nt", "tau", "mu"});
    }
    contact.Kn_Pa_m = table.quantity("Kn", Dimension::stiffness_gradient, positive);
    if (table.has("eta") && table.has("kratio"))
        table.fail("kratio", "given beside eta, of which it is the inverse", "either eta = ks/kn or kratio = kn/ks");
    if (!table.has("eta") && !table.has("kratio")) table.fail("eta", "missing key: eta", "eta = ks/kn, or kratio = kn/ks");
    contact.eta = table.has("eta") ? table.number("eta", positive) : 1.0 / table.number("kratio", positive);
    contact.sigma_nt_Pa = table.quantity("sigma_nt", Dimension::stress, positive);
    contact.tau_Pa = table.quantity("tau", Dimension::stress, positive);
    contact.mu = table.number("mu", not_negative);
    if (softens) {
        contact.Gfn_J_m2 = table.quantity("Gfn", Dimension::fracture_energy, positive);
        contact.Gfs_J_m2 = table.quantity("Gfs", Dimension::fracture_energy, positive);
        contact.shear_measure = table.choice<ShearMeasure>(
            "shear_measure", {{"total", ShearMeasure::total}, {"beyond-friction", ShearMeasure::beyond_friction}},
            contact.shear_measure);
        contact.tension_unloading = table.choice<TensionUnloading>(
            "tension_unloading", {{"elastic", TensionUnloading::elastic}, {"secant", TensionUnloading::secant}},
            contact.tension_unloading);
    }
    return contact;
}

NumericsSpec read_numerics(const TableReader& root) {
    NumericsSpec numerics;
    if (!root.has("numerics")) return numerics;
    const TableReader table = root.table("numerics", {"kind", "accuracy", "residual_target", "damping", "speed", "mass_factor",
                                                      "time_step", "maximum_steps", "confirm"});
    numerics.kind = table.choice<NumericsKind>(
        "kind", {{"adaptive", NumericsKind::adaptive}, {"paper", NumericsKind::paper}, {"dynamic", NumericsKind::dynamic}},
        numerics.kind);
    switch (numerics.kind) {
        case NumericsKind::adaptive:
            table.refuse({"speed"}, "kind = \"adaptive\", which finds its own speed",
                         "accuracy; or kind = \"paper\" or \"dynamic\" with a speed");
            table.refuse({"damping", "time_step"}, "kind = \"adaptive\"",
                         "accuracy, residual_target, mass_factor, maximum_steps, confirm");
            break;
        case NumericsKind::paper:
            table.refuse({"accuracy", "residual_target", "time_step"}, "kind = \"paper\"",
                         "damping, speed, mass_factor, maximum_steps, confirm");
            break;
        case NumericsKind::dynamic:
            table.refuse({"accuracy", "residual_target", "mass_factor"}, "kind = \"dynamic\"",
                         "damping, speed, time_step, maximum_steps, confirm");
            table.require({"speed"});
            break;
    }
    // a hair wider than stated, for 0.05 % is not the same double as 0.0005
    const Range accuracy{0.0005 * (1.0 - 1e-12), 0.1 * (1.0 + 1e-12), true, true, "from 0.05 % to 10 %"};
    numerics.accuracy = table.fraction("accuracy", accuracy, numerics.accuracy);
    if (table.has("residual_target")) {
        if (table.has("accuracy"))
            table.fail("residual_target", "given beside accuracy, which it would override", "one of the two");
        numerics.residual_target = table.number("residual_target", {0.0, 0.5, false, true, "greater than 0, at most 0.5"});
    }
    numerics.damping = table.number("damping", {0.0, 1.0, true, false, "0 or greater and less than 1"}, numerics.damping);
    if (table.has("speed"))
        numerics.speed_m = table.quantity(
            "speed", numerics.kind == NumericsKind::paper ? Dimension::speed_per_step : Dimension::speed, positive);
    if (table.has("mass_factor")) numerics.mass_factor = table.number("mass_factor", positive);
    if (table.has("time_step")) numerics.time_step_s = table.quantity("time_step", Dimension::time, positive);
    if (table.has("maximum_steps"))
        numerics.maximum_steps = table.integer("maximum_steps", 1, std::numeric_limits<long long>::max());
    numerics.confirm = table.flag("confirm", numerics.confirm);
    return numerics;
}

std::map<std::string, double> read_laboratory(const TableReader& root) {
    std::map<std::string, double> values;
    if (!root.has("laboratory")) return values;
    const TableReader table = root.table(
        "laboratory", {"E", "nu", "UCS", "DTS", "BTS", "cohesion", "c", "friction_angle", "phi", "hoek_brown_mi", "mi"});
    const auto one_of = [&](std::string_view name, std::string_view alias) {
        if (table.has(name) && table.has(alias))
            table.fail(alias, "given beside " + std::string(name) + ", which is the same", "one of the two");
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

}  // namespace feldspar
