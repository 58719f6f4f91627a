// Holes, notches and labels by place of [specimen].
#include "feldspar/job/job_sections.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr std::size_t most_vertices = 10000;
constexpr double near_a_line_m = 1e-5;  // an edge on a straight side is on it to rounding

void read_two_points(const JobTable& table, std::string_view key, Vec2& a, Vec2& b) {
    const toml::array& points = table.array(key);
    table.check({key}, [&] {
        if (points.size() != 2)
            table.fail(key, "is not two points", "two points such as [[\"0 mm\", \"0 mm\"], [\"1 mm\", \"80 mm\"]]");
        a = table.point_of(*points.get(0), key);
        b = table.point_of(*points.get(1), key);
    });
}

HoleSpec read_hole(const JobTable& table) {
    HoleSpec hole;
    hole.label = table.text("label", "");
    if (table.has("vertices")) {
        table.refuse({"centre", "diameter"}, "a hole with vertices", "vertices, label");
        const toml::array& vertices = table.array("vertices");
        table.check({"vertices"}, [&] {
            if (vertices.size() < 3 || vertices.size() > most_vertices)
                table.fail("vertices", std::to_string(vertices.size()) + " vertices make no hole",
                           "from three to 10000 vertices; or centre and diameter");
            for (const toml::node& vertex : vertices) hole.vertices_m.push_back(table.point_of(vertex, "vertices"));
        });
        return hole;
    }
    table.require({"centre", "diameter"});
    hole.centre_m = table.point("centre");
    hole.diameter_m = table.quantity("diameter");
    return hole;
}

NotchSpec read_notch(const JobTable& table) {
    table.require({"from", "to", "width"});
    NotchSpec notch;
    notch.from_m = table.point("from");
    notch.to_m = table.point("to");
    notch.width_m = table.quantity("width");
    notch.label = table.text("label", "");
    notch.joined = table.flag("joined");
    table.check({"width", "joined"}, [&] {
        if (notch.joined && notch.width_m > 0.0)
            table.fail("joined", "a slit with a width has no faces that touch", "joined = true beside width = \"0 mm\"");
    });
    table.check({"from", "to"}, [&] {
        if (notch.from_m == notch.to_m) table.fail("to", "the notch ends where it begins", "two different points");
    });
    return notch;
}

PlaceLabelSpec read_label(const JobTable& table) {
    table.require({"name"});
    PlaceLabelSpec label;
    label.name = table.text("name");
    const int places = (table.has("at") ? 1 : 0) + (table.has("box") ? 1 : 0) + (table.has("line") ? 1 : 0);
    if (places != 1) {
        table.check({}, [&] {
            table.fail("name", places == 0 ? "the label has no place" : "the label has several places",
                       "one of: at with within, box, line");
        });
        table.do_not_miss({"at", "box", "line", "within"});
        return label;
    }
    if (table.has("at")) {
        label.a_m = table.point("at");
        label.within_m = table.quantity("within");
    } else if (table.has("box")) {
        label.kind = PlaceKind::box;
        table.refuse({"within"}, "a box", "name, box");
        read_two_points(table, "box", label.a_m, label.b_m);
    } else {
        label.kind = PlaceKind::line;
        label.within_m = table.quantity("within", near_a_line_m);
        read_two_points(table, "line", label.a_m, label.b_m);
    }
    return label;
}

}  // namespace

void read_cutouts(const JobTable& table, OutlineSpec& outline) {
    if (table.has("holes"))
        for (const JobTable& hole : table.tables("holes", "a hole")) outline.holes.push_back(read_hole(hole));
    if (table.has("notches"))
        for (const JobTable& notch : table.tables("notches", "a notch")) outline.notches.push_back(read_notch(notch));
    if (table.has("labels"))
        for (const JobTable& label : table.tables("labels", "a label")) outline.labels.push_back(read_label(label));
}

void check_cutouts(const JobTable& table, const SpecimenSpec& specimen) {
    if ((!specimen.outline.is_cut() && specimen.outline.arcs.empty()) ||
        (table.rows().path == "specimen" && !table.sound({"grains.diameter"})))
        return;
    table.check({"shape", "width", "height", "diameter", "hole_diameter", "vertices", "edge_labels", "arcs", "holes", "notches"},
                [&] {
                    try {
                        make_outline(specimen);
                    } catch (const InputError& error) {
                        const std::string& key = error.place().key;  // specimen.holes
                        table.fail(key.substr(key.find_last_of('.') + 1), error.problem(), error.allowed(), error.suggestion());
                    }
                });
}

}  // namespace feldspar
