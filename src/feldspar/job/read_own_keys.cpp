// Keys of [[test]] that belong to some methods only: beams, and fixtures and gauges of a custom test.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

Vec2 read_direction(const JobTable& table, std::string_view key, bool unit) {
    Vec2 direction{0.0, 1.0};
    const toml::array& pair = table.array(key);
    table.check({key}, [&] {
        const auto number = [&](std::size_t i) {
            const auto value = pair.size() == 2 ? pair.get(i)->value<double>() : std::nullopt;
            if (!value || !std::isfinite(*value))
                table.fail(key, "is not a direction", "x and y as plain numbers, such as [0, -1] for downwards");
            return *value;
        };
        direction = {number(0), number(1)};
        const double length = norm(direction);
        if (!(length > 0.0))
            table.fail(key, "has no direction: both numbers are 0",
                       unit ? "x and y, one of them not 0" : "leave it out for a fixture at rest");
        if (unit) direction = (1.0 / length) * direction;
    });
    return direction;
}

// A plate under a pressure or a force, which gives way along its normal.
void read_pressing(const JobTable& table, FixtureSpec& fixture) {
    fixture.pressed = table.has("pressure") || table.has("force");
    if (table.has("pressure")) fixture.pressure_Pa = table.quantity("pressure");
    if (table.has("force")) fixture.force_N = table.quantity("force");
    if (table.has("spring")) fixture.spring_Pa_m = table.quantity("spring");
    table.check({"pressure", "force", "spring"}, [&] {
        if (table.has("pressure") && table.has("force")) table.fail("force", "given beside pressure", "one of them");
        if (table.has("spring") && !fixture.pressed)
            table.fail("spring", "presses a plate that has no pressure and no force", "pressure or force beside it");
    });
    if (!fixture.pressed) return;
    table.check({"normal"}, [&] {
        if (std::abs(fixture.normal.x) > 1e-9 && std::abs(fixture.normal.y) > 1e-9)
            table.fail("normal", "a plate under a pressure gives way along its normal, which must be along x or y",
                       "[0, 1], [0, -1], [1, 0] or [-1, 0]");
    });
    table.check({"motion", "normal"}, [&] {
        if (std::abs(dot(fixture.motion, fixture.normal)) > 1e-9)
            table.fail("motion", "moves a plate along its normal, where its pressure decides how it moves",
                       "a motion along the plate, or no pressure");
    });
    if (fixture.contact.glued)
        table.check({"glued"}, [&] { table.fail("glued", "a plate under a pressure is not glued", "leave it out"); });
}

FixtureSpec read_fixture(const JobTable& table) {
    FixtureSpec fixture;
    table.require({"name", "kind"});
    fixture.name = table.text("name");
    const FixtureForm form = table.choice("kind", fixture_forms);
    if (!table.sound({"kind"})) {
        for (const JobKey& key : table.rows().keys) table.do_not_miss({key.name});
        return fixture;
    }
    table.suit("kind", name(form));
    if (table.has("on")) fixture.part.label = table.text("on");
    if (table.has("at")) {
        fixture.part.at = table.point("at");
        fixture.axis = fixture.part.at;
    }
    if (!table.has("on") && !table.has("at"))
        table.check({}, [&] { table.fail("on", "the fixture has no place", "on = the label of an edge, or at = a point"); });
    if (table.has("motion")) fixture.motion = read_direction(table, "motion", false);
    if (form == FixtureForm::pressure) {
        fixture.kind = FixtureKind::pressure;
        fixture.axis.reset();
        if (table.has("at")) fixture.part.reach_m = table.quantity("within");
        table.require({"pressure"});
        fixture.pressure_Pa = table.quantity("pressure");
        return fixture;
    }
    if (form == FixtureForm::boundary) {
        fixture.kind = FixtureKind::nodes;
        fixture.imposes_x = table.flag("holds_x");
        fixture.imposes_y = table.flag("holds_y");
        fixture.pins_middle = table.flag("pin");
        if (table.has("at")) fixture.part.reach_m = table.quantity("within");
        return fixture;
    }
    fixture.kind = FixtureKind::plate;
    fixture.normal = read_direction(table, "normal", true);
    fixture.part.facing = fixture.normal;
    fixture.contact.Kn_Pa_m = table.has("Kn") ? table.quantity("Kn") : 0.0;  // that of the test
    fixture.contact.mu = table.number("mu");
    fixture.contact.glued = table.flag("glued");
    if (form == FixtureForm::plate) {
        if (table.has("at")) fixture.part.reach_m = table.quantity("within");
        read_pressing(table, fixture);
        return fixture;
    }
    table.require({"at"});
    const double radius_m = table.quantity("radius");
    fixture.radius_m = form == FixtureForm::jaw ? radius_m : -radius_m;
    fixture.touch = Touch::nearest_axis;
    fixture.part.reach_m = table.has("within") ? table.quantity("within") : radius_m;
    return fixture;
}

// A box by its corners, or a circle.
GaugeRegion read_region(const JobTable& table) {
    GaugeRegion region;
    if (table.has("box") == (table.has("centre") || table.has("radius"))) {
        table.check({"box", "centre", "radius"}, [&] {
            if (table.has("box")) table.fail("box", "given beside centre and radius", "one region: box, or centre and radius");
            table.fail("box", "missing key: box (or centre and radius: the region)",
                       "box = [[\"10 mm\", \"20 mm\"], [\"30 mm\", \"40 mm\"]], or centre and radius");
        });
        return region;
    }
    if (!table.has("box")) {
        table.require({"centre", "radius"});
        region.a = table.point("centre");
        region.radius_m = table.quantity("radius");
        return region;
    }
    std::vector<Vec2> corners;
    table.pairs("box", "a corner", "two opposite corners: [[\"10 mm\", \"20 mm\"], [\"30 mm\", \"40 mm\"]]",
                [&](const toml::node& x, const toml::node& y) {
                    corners.push_back({table.first_of(x, "box"), table.second_of(y, "box")});
                });
    table.check({"box"}, [&] {
        if (corners.size() != 2 || corners[0].x == corners[1].x || corners[0].y == corners[1].y)
            table.fail("box", "is no box", "two opposite corners, such as [[\"10 mm\", \"20 mm\"], [\"30 mm\", \"40 mm\"]]");
        region.a = corners[0];
        region.b = corners[1];
    });
    return region;
}

void read_fixture_of(const JobTable& table, const TestSpec& test, GaugeSpec& gauge) {
    gauge.fixture = table.text("fixture");
    table.check({"fixture"}, [&] {
        std::vector<std::string_view> known;
        for (const FixtureSpec& fixture : test.custom.fixtures) known.push_back(fixture.name);
        if (std::ranges::find(known, gauge.fixture) == known.end())
            table.fail("fixture", fmt::format("'{}' is not a fixture of the test", gauge.fixture), listed(known),
                       did_you_mean(gauge.fixture, known));
    });
}

GaugeSpec read_gauge(const JobTable& table, const TestSpec& test) {
    GaugeSpec gauge;
    table.require({"name", "kind"});
    gauge.name = table.text("name");
    const GaugeForm form = table.choice("kind", gauge_forms);
    if (!table.sound({"kind"})) {
        for (const JobKey& key : table.rows().keys) table.do_not_miss({key.name});
        return gauge;
    }
    table.suit("kind", name(form));
    switch (form) {
        case GaugeForm::extension:
        case GaugeForm::strain: {
            const Vec2 from = table.point("from"), to = table.point("to"), line = to - from;
            const double length = norm(line);
            table.check({"from", "to"}, [&] {
                if (!(length > 0.0)) table.fail("to", "the gauge ends where it begins", "two different points");
            });
            const bool strain = form == GaugeForm::strain;
            const Vec2 weight = length > 0.0 ? (1.0 / (strain ? length * length : length)) * line : Vec2{};
            gauge.kind = strain ? GaugeKind::strain : GaugeKind::displacement;
            gauge.points = {{to, weight}, {from, -weight}};
            gauge.meaning =
                strain ? "extension between two points over their distance" : "by how much two points have moved apart";
            break;
        }
        case GaugeForm::mean_stress:
        case GaugeForm::mean_strain: {
            const bool stress = form == GaugeForm::mean_stress;
            gauge.kind = stress ? GaugeKind::mean_stress : GaugeKind::mean_strain;
            gauge.region = read_region(table);
            gauge.direction = read_direction(table, "direction", true);
            if (table.has("normal")) gauge.normal = read_direction(table, "normal", true);
            gauge.meaning =
                stress ? "mean stress in a region, compression positive" : "mean strain in a region, compression positive";
            break;
        }
        case GaugeForm::hole_stress: {
            gauge.kind = GaugeKind::hole_stress;
            table.require({"centre", "radius"});
            gauge.region.a = table.point("centre");
            gauge.region.radius_m = table.quantity("radius");
            gauge.points = {{gauge.region.a + gauge.region.radius_m * read_direction(table, "direction", true), {}}};
            gauge.meaning = "stress along the edge of a round hole, from the elastic field around it, compression positive";
            break;
        }
        case GaugeForm::energy: {
            gauge.kind = GaugeKind::energy;
            gauge.term = table.choice("term", energy_terms);
            gauge.meaning = gauge.term == EnergyTerm::supplied   ? "energy supplied by the loading"
                            : gauge.term == EnergyTerm::elastic  ? "elastic energy in grains and contacts"
                            : gauge.term == EnergyTerm::fracture ? "energy dissipated by fracture"
                            : gauge.term == EnergyTerm::friction ? "energy dissipated by friction"
                            : gauge.term == EnergyTerm::damping  ? "energy dissipated by numerical damping"
                                                                 : "kinetic energy";
            break;
        }
        case GaugeForm::displacement:
            gauge.meaning = table.has("fixture") ? "displacement of a fixture along a direction"
                                                 : "displacement of a point along a direction";
            gauge.direction = read_direction(table, "direction", true);
            if (table.has("at") == table.has("fixture"))
                table.check({"at", "fixture"}, [&] {
                    if (table.has("at")) table.fail("fixture", "given beside at", "one of them");
                    table.fail("at", "missing key: at (or fixture: what the gauge reads)",
                               "at = a point, or fixture = the name of a plate");
                });
            if (!table.has("fixture")) {
                gauge.points = {{table.has("at") ? table.point("at") : Vec2{}, gauge.direction}};
                gauge.direction = {};
                break;
            }
            read_fixture_of(table, test, gauge);
            break;
        case GaugeForm::force: {
            gauge.kind = GaugeKind::force;
            gauge.meaning = "force of the specimen on a fixture along a direction";
            gauge.direction = read_direction(table, "direction", true);
            table.require({"fixture"});
            if (table.has("fixture")) read_fixture_of(table, test, gauge);
            break;
        }
    }
    return gauge;
}

// Names of tests and gauges become those of files and columns.
void check_name(const JobTable& table, const std::string& given, std::set<std::string>& taken, const char* what,
                bool blanks = false) {
    table.check({"name"}, [&] {
        const auto fits = [&](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || (blanks && c == ' '); };
        const bool plain = !given.empty() && given.size() <= 40 && std::all_of(given.begin(), given.end(), fits);
        if (!plain) table.fail("name", fmt::format("'{}' cannot name {}", given, what), table.allowed("name"));
        if (!taken.insert(given).second)
            table.fail("name", fmt::format("'{}' is taken by another one", given), "a name of its own for each");
    });
}

double read_value(const JobTable& table, const MethodKey& key) {
    switch (key.form) {
        case MethodKeyForm::quantity:
            return table.quantity(key.name);
        case MethodKeyForm::number:
            return table.number(key.name);
        case MethodKeyForm::share:
            return table.fraction(key.name);
        case MethodKeyForm::whole:
            break;
    }
    return static_cast<double>(table.integer(key.name));
}

void read_method_key(const JobTable& table, const MethodKey& key, TestSpec& test) {
    if (!table.has(key.name)) return;
    std::vector<double>& values = test.own[std::string(key.name)];
    const toml::array* list = key.list ? table.find(key.name)->as_array() : nullptr;
    if (list == nullptr)
        values.push_back(read_value(table, key));
    else
        for (const toml::node& node : *list) table.check({}, [&] { values.push_back(table.quantity_of(node, key.name)); });
    if (!key.in_place_of.empty()) table.refuse({key.in_place_of}, std::string(key.name), "one of them");
    table.check({key.name}, [&] {
        if (values.empty()) table.fail(key.name, "the list is empty", "one value or more");
    });
}

// Those that the job gives, and the values that hold without the others.
void read_method_keys(const JobTable& table, TestSpec& test) {
    const std::span<const MethodKey> keys = method_of(test).keys;
    for (const MethodKey& key : keys) read_method_key(table, key, test);
    for (const MethodKey& key : keys) {
        const bool replaced = std::ranges::any_of(
            keys, [&](const MethodKey& other) { return other.in_place_of == key.name && test.own.contains(other.name); });
        if (key.value && !replaced) test.own.try_emplace(std::string(key.name), 1, *key.value);
    }
}

void read_custom(const JobTable& table, TestSpec& test) {
    table.require({"name", "fixture"});
    std::set<std::string> tests, fixtures, gauges;
    test.custom.name = table.text("name");
    check_name(table, test.custom.name, tests, "a test");
    table.check({"name"}, [&] {
        if (find_method(test.custom.name))
            table.fail("name", fmt::format("'{}' is a test method", test.custom.name), "another name");
    });
    if (table.has("length")) test.custom.length_m = table.quantity("length");
    if (table.has("width")) test.custom.width_m = table.quantity("width");
    if (table.has("gravity"))
        test.custom.gravity_m_s2 =
            table.quantity("gravity") *
            (table.has("gravity_direction") ? read_direction(table, "gravity_direction", true) : Vec2{0.0, -1.0});
    else
        table.refuse({"gravity_direction"}, "no gravity", "gravity = \"9.81 m/s2\" beside it");
    if (table.has("fixture"))
        for (const JobTable& one : table.tables("fixture", "a fixture")) {
            test.custom.fixtures.push_back(read_fixture(one));
            if (one.sound({"name"})) check_name(one, test.custom.fixtures.back().name, fixtures, "a fixture", true);
        }
    if (table.has("gauge"))
        for (const JobTable& one : table.tables("gauge", "a gauge")) {
            test.custom.gauges.push_back(read_gauge(one, test));
            if (one.sound({"name"})) check_name(one, test.custom.gauges.back().name, gauges, "a gauge");
        }
}

void read_until(const JobTable& table, TestSpec& test) {
    const JobTable until = table.table("until");
    until.require({"gauge", "at"});
    GaugeStop stop;
    stop.gauge = until.text("gauge");
    until.check({"gauge"}, [&] {
        const std::vector<std::string_view> known = gauge_names(test);
        if (!has_gauge(test, stop.gauge))
            until.fail("gauge", fmt::format("the test has no gauge called '{}'", stop.gauge),
                       known.empty() ? "a test with gauges" : listed(known), did_you_mean(stop.gauge, known));
    });
    if (until.sound({"gauge"})) stop.value = until.quantity_as("at", dimension_of_gauge(test, stop.gauge));
    test.stop_gauge = stop;
}

}  // namespace

Dimension dimension_of_gauge(const TestSpec& test, std::string_view gauge) {
    for (const GaugeSpec& spec : test.custom.gauges) {
        if (spec.name != gauge) continue;
        switch (spec.kind) {
            case GaugeKind::displacement:
                return Dimension::length;
            case GaugeKind::force:
                return Dimension::force;
            case GaugeKind::mean_stress:
            case GaugeKind::hole_stress:
                return Dimension::stress;
            case GaugeKind::energy:
                return Dimension::energy;
            case GaugeKind::strain:
            case GaugeKind::mean_strain:
                return Dimension::fraction;
        }
    }
    return method_of(test).reading == Reading::hole ? Dimension::stress
                                                    : Dimension::length;  // of other methods all are displacements
}

std::vector<std::string_view> gauge_names(const TestSpec& test) {
    std::vector<std::string_view> names(method_of(test).build.gauge_names.begin(), method_of(test).build.gauge_names.end());
    for (const GaugeSpec& gauge : test.custom.gauges) names.push_back(gauge.name);
    return names;
}

bool has_gauge(const TestSpec& test, std::string_view gauge) {
    return [&] {
        const std::vector<std::string_view> names = gauge_names(test);
        return std::ranges::find(names, gauge) != names.end();
    }();
}

void read_own_keys(const JobTable& table, TestSpec& test) {
    read_method_keys(table, test);
    if (method_of(test).specimen.fixtures_of_job) read_custom(table, test);
    if (table.has("until")) read_until(table, test);
}

}  // namespace feldspar
