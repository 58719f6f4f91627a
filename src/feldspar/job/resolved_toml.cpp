// A job written out in full: SI units, every default, digits enough to read back the same bits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "feldspar/base/units.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/keys.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

std::string quote(const std::string& text) {
    std::string result = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
        else
            result += c;
    }
    return result + "\"";
}

std::string si(double value, Dimension dimension) { return quote(format_si(value, dimension)); }

// The lines of a table: key = value. Keys and their dimensions are those of the rows (keys.hpp).
class Lines {
public:
    /// @param path  of the table among job_tables(); @param title  its head, or that of a variant's own table
    void head(std::string_view path, const std::string& title) {
        table_ = &job_table(path);
        text_ += (text_.empty() ? "" : "\n") + title + "\n";
    }
    void head(std::string_view path) { head(path, std::string(job_table(path).head)); }
    void raw(std::string_view key, const std::string& value) {
        text_ += std::string(table_->key(key).name) + " = " + value + "\n";
    }
    void word(std::string_view key, const std::string& value) { raw(key, quote(value)); }
    void number(std::string_view key, double value) { raw(key, format_exact(value)); }
    void quantity(std::string_view key, double value) { quantity(key, value, table_->key(key).value.element.dimension); }
    /// Of a key whose dimension another one decides.
    void quantity(std::string_view key, double value, Dimension dimension) { raw(key, si(value, dimension)); }
    std::string take() { return std::move(text_); }

private:
    const KeyTable* table_ = &job_table("");
    std::string text_;
};

template <class Items>
std::string list(const Items& items) {
    return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string point(Vec2 p) { return fmt::format("[{}, {}]", si(p.x, Dimension::length), si(p.y, Dimension::length)); }

std::string points(const std::vector<Vec2>& all) {
    std::vector<std::string> items;
    for (const Vec2 p : all) items.push_back(point(p));
    return list(items);
}

void write_cutouts(Lines& out, const OutlineSpec& outline) {
    std::vector<std::string> items;
    const auto label = [](const std::string& given) { return given.empty() ? std::string() : ", label = " + quote(given); };
    for (const HoleSpec& hole : outline.holes) {
        const std::string shape = hole.vertices_m.empty() ? fmt::format("centre = {}, diameter = {}", point(hole.centre_m),
                                                                        si(hole.diameter_m, Dimension::length))
                                                          : fmt::format("vertices = {}", points(hole.vertices_m));
        items.push_back(fmt::format("{{ {}{} }}", shape, label(hole.label)));
    }
    if (!items.empty()) out.raw("holes", list(items));
    items.clear();
    for (const NotchSpec& notch : outline.notches)
        items.push_back(fmt::format("{{ from = {}, to = {}, width = {}{}{} }}", point(notch.from_m), point(notch.to_m),
                                    si(notch.width_m, Dimension::length), label(notch.label),
                                    notch.joined ? ", joined = true" : ""));
    if (!items.empty()) out.raw("notches", list(items));
}

void write_place_labels(Lines& out, const OutlineSpec& outline) {
    std::vector<std::string> items;
    for (const PlaceLabelSpec& label : outline.labels) {
        const std::string within = si(label.within_m, Dimension::length);
        std::string place;
        switch (label.kind) {
            case PlaceKind::disc:
                place = fmt::format("at = {}, within = {}", point(label.a_m), within);
                break;
            case PlaceKind::box:
                place = fmt::format("box = {}", points({label.a_m, label.b_m}));
                break;
            case PlaceKind::line:
                place = fmt::format("line = {}, within = {}", points({label.a_m, label.b_m}), within);
                break;
        }
        items.push_back(fmt::format("{{ name = {}, {} }}", quote(label.name), place));
    }
    if (!items.empty()) out.raw("labels", list(items));
}

void write_outline(Lines& out, const OutlineSpec& outline) {
    out.word("shape", name(outline.shape));
    switch (outline.shape) {
        case Shape::rectangle:
            out.quantity("width", outline.width_m);
            out.quantity("height", outline.height_m);
            break;
        case Shape::disc:
        case Shape::half_disc:
            out.quantity("diameter", outline.diameter_m);
            break;
        case Shape::polygon: {
            std::vector<std::string> items;
            out.raw("vertices", points(outline.vertices_m));
            for (const std::string& label : outline.edge_labels) items.push_back(quote(label));
            if (!items.empty()) out.raw("edge_labels", fmt::format("[{}]", fmt::join(items, ", ")));
            items.clear();
            for (const ArcSpec& arc : outline.arcs)
                items.push_back(fmt::format("{{ edge = {}, through = {} }}", arc.edge, point(arc.through_m)));
            if (!items.empty()) out.raw("arcs", list(items));
            break;
        }
        case Shape::ring:
            out.quantity("diameter", outline.diameter_m);
            out.quantity("hole_diameter", outline.hole_diameter_m);
            break;
    }
    write_cutouts(out, outline);
    write_place_labels(out, outline);
}

std::string grain_sizes(const GrainSizeSpec& sizes) {
    switch (sizes.kind) {
        case GrainSizeKind::uniform:
            return fmt::format("{{ distribution = \"uniform\", minimum = {}, maximum = {} }}",
                               si(sizes.minimum_m, Dimension::length), si(sizes.maximum_m, Dimension::length));
        case GrainSizeKind::log_normal:
            return fmt::format(
                "{{ distribution = \"log-normal\", median = {}, log_standard_deviation = {}, minimum = {}, maximum = {} }}",
                si(sizes.median_m, Dimension::length), format_exact(sizes.log_standard_deviation),
                si(sizes.minimum_m, Dimension::length), si(sizes.maximum_m, Dimension::length));
        case GrainSizeKind::sieve:
            break;
    }
    std::vector<std::string> points;
    for (const SievePoint& point : sizes.sieve)
        points.push_back(fmt::format("[{}, {}]", si(point.diameter_m, Dimension::length), format_exact(point.passing)));
    return fmt::format("{{ distribution = \"sieve\", curve = [{}] }}", fmt::join(points, ", "));
}

void write_specimen(Lines& out, const SpecimenSpec& specimen) {
    out.head("specimen");
    write_outline(out, specimen.outline);
    out.quantity("thickness", specimen.thickness_m);
    if (!specimen.packing_file.empty()) out.word("packing", std::filesystem::absolute(specimen.packing_file).string());
    out.head("specimen.grains");
    const GivenCellsSpec& cells = specimen.given_cells;
    if (cells.given()) {
        if (!cells.file.empty()) out.word("file", std::filesystem::absolute(cells.file).string());
        out.raw("unit", si(cells.unit_m, Dimension::length));
        out.number("tolerance", cells.tolerance);
    } else if (specimen.phase_sizes.empty()) {  // else each mineral has its own
        out.raw("diameter", grain_sizes(specimen.grain_sizes));
    }
    if (specimen.crystal_sizes) out.raw("crystals", grain_sizes(*specimen.crystal_sizes));
    if (!cells.given()) out.number("porosity", specimen.porosity);
    if (!specimen.merge_length_m)
        out.word("merge_length", "auto");
    else if (*specimen.merge_length_m == 0.0)
        out.word("merge_length", "none");
    else
        out.quantity("merge_length", *specimen.merge_length_m);
    out.raw("triangles_per_grain", std::to_string(specimen.triangles_per_grain));
    if (specimen.particles_per_grain > 0.0) out.number("particles_per_grain", specimen.particles_per_grain);
}

void write_model(Lines& out, const ModelSpec& model, const std::string& place) {
    out.head("model", "[" + place + "model]");
    out.word("kind", name(model.kind));
    out.word("contact", name(model.contact));
    out.word("normal", name(model.normal));
    if (model.kind == GrainKind::flexible) out.word("plane", name(model.plane));
}

void write_materials(Lines& out, const Variant& variant, const std::string& place) {
    const ContactMaterial& contact = variant.contact;
    if (variant.rock.minerals.phases.empty()) {  // else each mineral has its own
        out.head("material.grain", "[" + place + "material.grain]");
        if (variant.model.kind == GrainKind::flexible) {
            out.quantity("E", variant.grain.E_Pa);
            out.number("nu", variant.grain.nu);
        }
        out.quantity("density", variant.grain.density_kg_m3);
    }
    out.head("material.contact", "[" + place + "material.contact]");
    out.word("law", name(contact.law));
    out.quantity("Kn", contact.Kn_Pa_m);
    out.number("eta", contact.eta);
    out.quantity("sigma_nt", contact.sigma_nt_Pa);
    out.quantity("tau", contact.tau_Pa);
    out.number("mu", contact.mu);
    if (contact.law == ContactLaw::brittle) return;
    out.quantity("Gfn", contact.Gfn_J_m2);
    out.quantity("Gfs", contact.Gfs_J_m2);
    out.word("shear_measure", name(contact.shear_measure));
    out.word("tension_unloading", name(contact.tension_unloading));
}

void write_distribution(std::vector<std::string>& items, const Distribution& d) {
    items.push_back(fmt::format("distribution = \"{}\"", name(d.kind)));
    if (d.kind == DistributionKind::weibull)
        items.push_back("modulus = " + format_exact(d.weibull_modulus));
    else
        items.push_back("variation = " + format_exact(d.variation));
    items.push_back("lowest = " + format_exact(d.lowest));
    if (std::isfinite(d.highest)) items.push_back("highest = " + format_exact(d.highest));
    if (d.correlation_length_m > 0.0) items.push_back("correlation_length = " + si(d.correlation_length_m, Dimension::length));
}

void write_changes(Lines& out, const ContactChanges& c) {
    for (const auto& [key, value] : {std::pair{"Kn", c.Kn_Pa_m}, std::pair{"sigma_nt", c.sigma_nt_Pa}, std::pair{"tau", c.tau_Pa},
                                     std::pair{"Gfn", c.Gfn_J_m2}, std::pair{"Gfs", c.Gfs_J_m2}})
        if (value) out.quantity(key, *value);
    for (const auto& [key, value] : {std::pair{"eta", c.eta}, std::pair{"mu", c.mu}})
        if (value) out.number(key, *value);
}

void write_minerals(Lines& out, const Variant& variant, const std::string& place, const std::vector<PhaseSizes>& sizes) {
    const MineralSpec& minerals = variant.rock.minerals;
    for (const Mineral& phase : minerals.phases) {
        out.head("material.phase", "[[" + place + "material.phase]]");
        out.word("name", phase.name);
        out.number("share", phase.share);
        if (variant.model.kind == GrainKind::flexible) {
            out.quantity("E", phase.grain.E_Pa);
            out.number("nu", phase.grain.nu);
        }
        out.quantity("density", phase.grain.density_kg_m3);
        out.word("colour", fmt::format("#{:06x}", phase.colour));
        if (phase.value >= 0) out.raw("value", std::to_string(phase.value));
        for (const PhaseSizes& one : sizes)
            if (one.name == phase.name) out.raw("diameter", grain_sizes(one.sizes));
    }
    for (const PhasePair& pair : minerals.pairs) {
        out.head("material.pair", "[[" + place + "material.pair]]");
        out.raw("phases", fmt::format("[{}, {}]", quote(minerals.phases[pair.a].name), quote(minerals.phases[pair.b].name)));
        if (pair.inside) out.raw("inside", "true");
        write_changes(out, pair.changes);
    }
    if (const ContactChanges& c = variant.rock.crystal; c.any()) {
        out.head("material.crystal", "[" + place + "material.crystal]");
        write_changes(out, c);
    }
    if (minerals.phases.empty()) return;
    out.head("material.minerals", "[" + place + "material.minerals]");
    out.word("unlike", name(minerals.unlike));
    out.number("unlike_strength", minerals.unlike_strength);
    if (minerals.cluster_length_m > 0.0) out.quantity("cluster_length", minerals.cluster_length_m);
    if (minerals.map) out.word("map", minerals.map_file);
    if (!minerals.list.empty()) out.word("list", minerals.list_file);
}

void write_joints(Lines& out, const Variant& variant, const std::string& place) {
    for (const JointSpec& joint : variant.rock.joints) {
        out.head("material.joint", "[[" + place + "material.joint]]");
        out.word("name", joint.name);
        if (joint.set) {
            const JointSet& set = *joint.set;
            std::vector<std::string> items{"dip = " + si(set.dip_rad, Dimension::angle),
                                           "dip_deviation = " + si(set.dip_deviation_rad, Dimension::angle),
                                           "spacing = " + si(set.spacing_m, Dimension::length),
                                           "spacing_variation = " + format_exact(set.spacing_variation)};
            if (set.length_m > 0.0)
                items.insert(items.end(), {"length = " + si(set.length_m, Dimension::length),
                                           "length_variation = " + format_exact(set.length_variation),
                                           "persistence = " + format_exact(set.persistence)});
            out.raw("set", fmt::format("{{ {} }}", fmt::join(items, ", ")));
        } else if (!joint.cut.empty()) {
            out.word("cut", joint.cut);
        } else if (!joint.file.empty()) {
            out.word("file", joint.file);
            if (!joint.unit.empty()) out.word("unit", joint.unit);
            if (!joint.layer.empty()) out.word("layer", joint.layer);
        } else {
            out.raw("trace", points(joint.lines_m.front()));
        }
        const ContactMaterial& c = joint.contact;
        out.quantity("Kn", c.Kn_Pa_m);
        out.number("eta", c.eta);
        out.quantity("sigma_nt", c.sigma_nt_Pa);
        out.quantity("tau", c.tau_Pa);
        out.number("mu", c.mu);
        out.quantity("Gfn", c.Gfn_J_m2);
        out.quantity("Gfs", c.Gfs_J_m2);
        out.quantity("opening", joint.opening_m);
        if (!(joint.dilation > 0.0)) continue;
        out.raw("dilation", si(std::atan(joint.dilation), Dimension::angle));
        out.quantity("dilation_slip", joint.dilation_slip_m);
    }
}

// What makes the rock uneven; nothing of a rock that is even, so that identities of its runs stay as they were.
void write_rock(Lines& out, const Variant& variant, const std::string& place, const std::vector<PhaseSizes>& sizes) {
    write_minerals(out, variant, place, sizes);
    const ScatterSpec& scatter = variant.rock.scatter;
    if (scatter.any()) {
        out.head("material.scatter", "[" + place + "material.scatter]");
        for (const Scattered quantity : scattered_quantities) {
            if (!scatter[quantity].scatters()) continue;
            std::vector<std::string> items;
            write_distribution(items, scatter[quantity]);
            out.raw(name(quantity), fmt::format("{{ {} }}", fmt::join(items, ", ")));
        }
        out.number("energy_power", scatter.energy_power);
    }
    const InitialCracks& cracks = variant.rock.initial_cracks;
    if (cracks.any()) {
        out.head("material.initial_cracks", "[" + place + "material.initial_cracks]");
        out.number("broken", cracks.broken);
        out.quantity("opening", cracks.opening_m);
        out.number("weakened", cracks.weakened);
        if (cracks.weakened > 0.0) out.number("weakened_strength", cracks.weakened_strength);
    }
    write_joints(out, variant, place);
}

void write_numerics(Lines& out, const NumericsSpec& numerics, const std::string& place) {
    out.head("numerics", "[" + place + "numerics]");
    out.word("kind", name(numerics.kind));
    if (numerics.kind == NumericsKind::adaptive) {
        if (numerics.residual_target)
            out.number("residual_target", *numerics.residual_target);
        else
            out.number("accuracy", numerics.accuracy);
    }
    out.number("damping", numerics.damping);
    if (numerics.speed_m)
        out.quantity("speed", *numerics.speed_m,
                     numerics.kind == NumericsKind::paper ? Dimension::speed_per_step : Dimension::speed);
    if (numerics.mass_factor) out.number("mass_factor", *numerics.mass_factor);
    if (numerics.time_step_s) out.quantity("time_step", *numerics.time_step_s);
    if (numerics.maximum_steps) out.raw("maximum_steps", std::to_string(*numerics.maximum_steps));
    out.raw("confirm", numerics.confirm ? "true" : "false");
}

void write_plates(Lines& out, const TestSpec& test, const Job& job) {
    const bool particles = std::any_of(job.variants.begin(), job.variants.end(), [&](const Variant& variant) {
        return variant.runs(test.kind) && variant.model.kind != GrainKind::flexible;
    });
    if (!particles && !method_of(test).specimen.plates && !(test.plate_mu.value_or(0.0) > 0.0)) return;
    if (method_of(test).specimen.own_disc) out.word("plates", name(test.plates));
    if (test.plates == PlateShape::curved) out.number("jaw_radius", test.jaw_radius);
    if (test.plate_Kn_Pa_m)
        out.quantity("plate_Kn", *test.plate_Kn_Pa_m);
    else
        out.number("plate_stiffness_factor", test.plate_stiffness_factor);
    if (test.plate_mu) out.number("plate_mu", *test.plate_mu);
    if (particles && method_of(test).specimen.confined) out.raw("membrane_plates", std::to_string(test.membrane_plates));
}

std::string direction(Vec2 d) { return fmt::format("[{}, {}]", format_exact(d.x), format_exact(d.y)); }

void write_until(Lines& out, const TestSpec& test) {
    out.head("test.until");
    out.word("gauge", test.stop_gauge->gauge);
    out.quantity("at", test.stop_gauge->value, dimension_of_gauge(test, test.stop_gauge->gauge));
}

void write_fixture(Lines& out, const FixtureSpec& fixture) {
    const FixtureForm form = fixture.kind == FixtureKind::nodes      ? FixtureForm::boundary
                             : fixture.kind == FixtureKind::pressure ? FixtureForm::pressure
                             : fixture.radius_m == 0.0               ? FixtureForm::plate
                             : fixture.radius_m > 0.0                ? FixtureForm::jaw
                                                                     : FixtureForm::roller;
    const auto flag = [&](const char* key, bool value) { out.raw(key, value ? "true" : "false"); };
    out.head("test.fixture");
    out.word("name", fixture.name);
    out.word("kind", name(form));
    if (!fixture.part.label.empty()) out.word("on", fixture.part.label);
    if (fixture.part.at) {
        out.raw("at", point(*fixture.part.at));
        out.quantity("within", fixture.part.reach_m);
    }
    if (fixture.moves()) out.raw("motion", direction(fixture.motion));
    if (form == FixtureForm::pressure) return out.quantity("pressure", fixture.pressure_Pa);
    if (form == FixtureForm::boundary) {
        flag("holds_x", fixture.imposes_x);
        flag("holds_y", fixture.imposes_y);
        flag("pin", fixture.pins_middle);
        return;
    }
    out.raw("normal", direction(fixture.normal));
    if (fixture.radius_m != 0.0) out.quantity("radius", std::abs(fixture.radius_m));
    if (fixture.contact.Kn_Pa_m > 0.0) out.quantity("Kn", fixture.contact.Kn_Pa_m);
    out.number("mu", fixture.contact.mu);
    if (fixture.pressed) {
        if (fixture.force_N != 0.0)
            out.quantity("force", fixture.force_N, Dimension::force);
        else
            out.quantity("pressure", fixture.pressure_Pa);
        if (fixture.spring_Pa_m != 0.0) out.quantity("spring", fixture.spring_Pa_m);
        return;
    }
    flag("glued", fixture.contact.glued);
}

GaugeForm form_of(const GaugeSpec& gauge) {
    switch (gauge.kind) {
        case GaugeKind::force:
            return GaugeForm::force;
        case GaugeKind::strain:
            return GaugeForm::strain;
        case GaugeKind::mean_stress:
            return GaugeForm::mean_stress;
        case GaugeKind::mean_strain:
            return GaugeForm::mean_strain;
        case GaugeKind::hole_stress:
            return GaugeForm::hole_stress;
        case GaugeKind::energy:
            return GaugeForm::energy;
        case GaugeKind::displacement:
            break;
    }
    return gauge.points.size() == 2 ? GaugeForm::extension : GaugeForm::displacement;
}

void write_circle(Lines& out, const GaugeRegion& region) {
    out.raw("centre", point(region.a));
    out.quantity("radius", region.radius_m);
}

void write_gauge(Lines& out, const GaugeSpec& gauge) {
    out.head("test.gauge");
    out.word("name", gauge.name);
    const GaugeForm form = form_of(gauge);
    out.word("kind", name(form));
    if (form == GaugeForm::force) {
        out.word("fixture", gauge.fixture);
        out.raw("direction", direction(gauge.direction));
    } else if (form == GaugeForm::energy) {
        out.word("term", name(gauge.term));
    } else if (form == GaugeForm::hole_stress) {
        write_circle(out, gauge.region);
        out.raw("direction", direction((1.0 / gauge.region.radius_m) * (gauge.points.front().at - gauge.region.a)));
    } else if (form == GaugeForm::mean_stress || form == GaugeForm::mean_strain) {
        if (gauge.region.radius_m > 0.0)
            write_circle(out, gauge.region);
        else
            out.raw("box", "[" + point(gauge.region.a) + ", " + point(gauge.region.b) + "]");
        out.raw("direction", direction(gauge.direction));
        if (gauge.normal != Vec2{}) out.raw("normal", direction(gauge.normal));
    } else if (form == GaugeForm::displacement && gauge.points.empty()) {
        out.word("fixture", gauge.fixture);
        out.raw("direction", direction(gauge.direction));
    } else if (form == GaugeForm::displacement) {
        out.raw("at", point(gauge.points.front().at));
        out.raw("direction", direction(gauge.points.front().weight));
    } else {
        out.raw("from", point(gauge.points.back().at));
        out.raw("to", point(gauge.points.front().at));
    }
}

void write_method_key(Lines& out, const TestSpec& test, const MethodKey& key) {
    const auto found = test.own.find(key.name);
    if (found == test.own.end()) return;
    const std::string name(key.name);
    const double value = found->second.front();
    if (key.form == MethodKeyForm::whole) return out.raw(name, std::to_string(static_cast<long long>(value)));
    if (key.form != MethodKeyForm::quantity) return out.number(name, value);
    if (!key.list) return out.quantity(name, value);
    std::string values;
    for (const double one : found->second)
        values += (values.empty() ? "" : ", ") + as_written(job_key("test", key.name).value, one);
    out.raw(name, "[" + values + "]");
}

std::string stage_in_braces(const TestSpec& test, const StageSpec& stage) {
    std::string text = fmt::format("kind = {}", quote(name(stage.kind)));
    if (stage.kind == StageKind::hold)
        return stage.travel_times ? text + fmt::format(", travel_times = {}", format_exact(*stage.travel_times)) : text;
    if (stage.kind == StageKind::confine)
        return text + fmt::format(", sigma3 = {}{}, keep = {}", si(stage.sigma3_Pa, Dimension::stress),
                                  stage.fixture.empty() ? "" : ", fixture = " + quote(stage.fixture), quote(name(stage.keep)));
    if (stage.end == StageEnd::test) return text;
    text += fmt::format(", until = {}", quote(stage.end == StageEnd::gauge ? stage.gauge : name(stage.end)));
    if (stage.end == StageEnd::reversal) return text;
    const char* key = stage.counts == StageValue::reached ? "at" : stage.counts == StageValue::changed ? "by" : "beyond";
    const Dimension dimension = stage.end == StageEnd::stress  ? Dimension::stress
                                : stage.end == StageEnd::load  ? Dimension::force
                                : stage.end == StageEnd::gauge ? dimension_of_gauge(test, stage.gauge)
                                                               : Dimension::fraction;
    return text + fmt::format(", {} = {}", key, si(stage.value, dimension));
}

std::string stages(const TestSpec& test) {
    std::vector<std::string> groups;
    for (const StageGroup& group : test.stages) {
        std::vector<std::string> members;
        for (const StageSpec& stage : group.stages) members.push_back("{ " + stage_in_braces(test, stage) + " }");
        if (group.times == 1 && members.size() == 1)
            groups.push_back(members.front());
        else
            groups.push_back(fmt::format("{{ kind = \"cycle\", {}stages = {} }}",
                                         group.times == 0 ? "" : fmt::format("times = {}, ", group.times), list(members)));
    }
    return list(groups);
}

void write_test(Lines& out, const TestSpec& test, const Job& job) {
    out.head("test");
    out.word("kind", name(test.kind));
    if (!test.custom.name.empty()) out.word("name", test.custom.name);
    if (method_of(test).reading == Reading::stages) {
        std::vector<std::string> pressures{si(test.sigma3_Pa, Dimension::stress)};
        for (const double sigma3_Pa : test.later_sigma3_Pa) pressures.push_back(si(sigma3_Pa, Dimension::stress));
        out.raw("sigma3", list(pressures));
    } else if (tells_pressure(test)) {
        out.quantity(pressure_key(method_of(test)), test.sigma3_Pa);
    }
    for (const MethodKey& key : method_of(test).keys) write_method_key(out, test, key);
    if (!test.stages.empty()) out.raw("stages", stages(test));
    out.number("stop_fraction", test.stop_fraction);
    out.word("control", test.control == LoadControl::gauge ? test.control_gauge : name(test.control));
    out.number("maximum_strain", test.maximum_strain);
    if (test.maximum_stress_Pa) out.quantity("maximum_stress", *test.maximum_stress_Pa);
    if (method_of(test).specimen.own_disc) out.quantity("diameter", test.specimen->outline.diameter_m);
    // whole discs are left unwritten: identities of their runs stay as they were
    if (method_of(test).specimen.own_disc && test.specimen->outline.flat_angle_rad > 0.0) {
        out.word("disc", name(DiscForm::flattened));
        out.quantity("flat_angle", test.specimen->outline.flat_angle_rad);
    }
    write_plates(out, test, job);
    if (test.custom.length_m) out.quantity("length", *test.custom.length_m);
    if (test.custom.width_m) out.quantity("width", *test.custom.width_m);
    if (const Vec2 g = test.custom.gravity_m_s2; g != Vec2{}) {
        out.quantity("gravity", norm(g), Dimension::acceleration);
        out.raw("gravity_direction", direction((1.0 / norm(g)) * g));
    }
    out.raw("snapshots", std::to_string(test.snapshots));
    if (!test.seeds.empty()) out.raw("seeds", list(test.seeds));
    if (test.stop_gauge) write_until(out, test);
    if (test.specimen && !method_of(test).specimen.own_disc) {
        out.head("test.specimen");
        write_outline(out, test.specimen->outline);
    }
    for (const FixtureSpec& fixture : test.custom.fixtures) write_fixture(out, fixture);
    for (const GaugeSpec& gauge : test.custom.gauges) write_gauge(out, gauge);
}

// The physics of one variant under `place`: "" for the job's own tables, "variant." for a list.
void write_physics(Lines& out, const Variant& variant, const std::string& place, const Job& job) {
    write_model(out, variant.model, place);
    write_materials(out, variant, place);
    write_rock(out, variant, place, job.specimen.phase_sizes);
    write_numerics(out, variant.numerics, place);
}

void write_variant(Lines& out, const Variant& variant, const Job& job) {
    out.head("variant");
    out.word("name", variant.name);
    if (!variant.seeds.empty()) out.raw("seeds", list(variant.seeds));
    std::vector<std::string> kinds;
    for (MethodId kind : variant.tests) kinds.push_back(quote(name(kind)));
    if (!kinds.empty()) out.raw("tests", list(kinds));
    write_physics(out, variant, "variant.", job);
}

void write_laboratory(Lines& out, const Job& job) {
    if (job.laboratory.empty() && job.laboratory_confined.empty()) return;
    out.head("laboratory");
    for (const auto& [key, value] : job.laboratory) {
        if (job_key("laboratory", key).value.element.form == ValueForm::quantity)
            out.quantity(key, value);
        else
            out.number(key, value);
    }
    if (job.laboratory_confined.empty()) return;
    std::string pairs;
    for (const ConfinedStrength& c : job.laboratory_confined)
        pairs += (pairs.empty() ? "" : ", ") + ("[\"" + format_si(c.sigma3_Pa, Dimension::stress) + "\", \"" +
                                                format_si(c.sigma1_Pa, Dimension::stress) + "\"]");
    out.raw("confined", "[" + pairs + "]");
}

}  // namespace

std::string resolved_toml(const Job& job) {
    Lines out;
    out.word("name", job.name);
    write_specimen(out, job.specimen);
    if (job.has_variants())
        for (const Variant& variant : job.variants) write_variant(out, variant, job);
    else
        write_physics(out, job.variants.front(), "", job);
    for (const TestSpec& test : job.tests) write_test(out, test, job);
    out.head("run");
    out.raw("seeds", list(job.seeds));
    out.raw("threads", job.threads == 0 ? "\"auto\"" : std::to_string(job.threads));
    out.raw("at_once", job.at_once == 0 ? "\"auto\"" : std::to_string(job.at_once));
    write_laboratory(out, job);
    return out.take();
}

}  // namespace feldspar
