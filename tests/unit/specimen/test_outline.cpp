// From the user's outline to one ready for use.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "feldspar/base/error.hpp"
#include "feldspar/specimen/outline.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

TEST(Outline, RectangleStandsOnTheAxesWithItsLabels) {
    const Outline o = make_outline(rectangle(0.08, 0.16).outline);
    EXPECT_EQ(o.vertices, (std::vector<Vec2>{{0, 0}, {0.08, 0}, {0.08, 0.16}, {0, 0.16}}));
    EXPECT_EQ(o.edge_labels, (std::vector<std::string>{"bottom", "right", "top", "left"}));
    EXPECT_DOUBLE_EQ(o.area_m2, 0.08 * 0.16);
    EXPECT_FALSE(o.is_disc);
}

TEST(Outline, DiscIsCentredAtTheOrigin) {
    const Outline o = make_outline(disc(0.08).outline);
    EXPECT_TRUE(o.is_disc);
    EXPECT_EQ(o.centre, (Vec2{0, 0}));
    EXPECT_DOUBLE_EQ(o.area_m2, std::numbers::pi * 0.0016);
    EXPECT_EQ(o.edge_labels, std::vector<std::string>{"circle"});
}

TEST(Outline, ClockwisePolygonIsTurnedAndKeepsEachLabelOnItsEdge) {
    OutlineSpec spec = triangle().outline;
    spec.edge_labels = {"base", "long", "short"};
    const Outline direct = make_outline(spec);
    std::swap(spec.vertices_m[1], spec.vertices_m[2]);  // now clockwise: short, long, base reversed
    spec.edge_labels = {"short", "long", "base"};
    const Outline turned = make_outline(spec);
    EXPECT_GT(signed_area(turned.vertices), 0.0);
    const auto label_of = [](const Outline& o, Vec2 middle) {
        for (std::size_t k = 0; k < o.vertices.size(); ++k) {
            if (norm(0.5 * (o.vertices[k] + o.vertices[(k + 1) % o.vertices.size()]) - middle) < 1e-12) return o.edge_labels[k];
        }
        return std::string("none");
    };
    for (const Vec2 middle : {Vec2{0.025, 0}, Vec2{0.03, 0.02}, Vec2{0.005, 0.02}}) {
        EXPECT_EQ(label_of(direct, middle), label_of(turned, middle));
        EXPECT_NE(label_of(direct, middle), "none");
    }
}

TEST(Outline, UnlabelledEdgesGetNumbersInTheUsersOrder) {
    const Outline o = make_outline(ell().outline);
    EXPECT_EQ(o.edge_labels.front(), "edge-0");
    EXPECT_EQ(o.edge_labels.back(), "edge-5");
}

// A dog bone: the sides of 80 x 160 mm are arcs that come in by 20 mm in the middle.
OutlineSpec dog_bone(bool clockwise = false) {
    OutlineSpec spec;
    spec.shape = Shape::polygon;
    spec.vertices_m = {{0, 0}, {0.08, 0}, {0.08, 0.16}, {0, 0.16}};
    spec.edge_labels = {"bottom", "right", "top", "left"};
    spec.arcs = {{1, {0.06, 0.08}}, {3, {0.02, 0.08}}};
    if (clockwise) {
        std::reverse(spec.vertices_m.begin(), spec.vertices_m.end());
        spec.edge_labels = {"top", "right", "bottom", "left"};
        spec.arcs = {{1, {0.06, 0.08}}, {3, {0.02, 0.08}}};
    }
    return spec;
}

TEST(Outline, RoundEdgesAreDividedAndKeepTheirLabel) {
    // A chord of 160 mm and a rise of 20 mm: R = (80^2 + 20^2) / 40 = 170 mm.
    constexpr double R = 0.17, rise = 0.02, chord = 0.16;
    const double half = std::asin(0.5 * chord / R), segment = R * R * (half - std::sin(half) * std::cos(half));
    for (const bool clockwise : {false, true}) {
        for (const double grain : {0.0, 0.003, 0.0003}) {
            const Outline o = make_outline(dog_bone(clockwise), {grain, grain});
            ASSERT_EQ(o.vertices.size(), o.edge_labels.size());
            std::size_t on_right = 0;
            for (std::size_t k = 0; k < o.vertices.size(); ++k) {
                if (o.edge_labels[k] != "right") continue;
                ++on_right;
                EXPECT_NEAR(norm(o.vertices[k] - Vec2{0.08 - rise + R, 0.08}), R, 1e-12);
            }
            EXPECT_EQ(on_right,
                      static_cast<std::size_t>(std::max(2L, std::lround(arc_edges(R, grain) * half / std::numbers::pi))));
            const double fine =
                2.0 * half /
                static_cast<double>(on_right);  // a polygon inside the circle has less of the segment, of the second order
            EXPECT_NEAR(o.area_m2, 0.08 * chord - 2.0 * segment, 1.2 * 2.0 * segment * fine * fine);
            EXPECT_GT(signed_area(o.vertices), 0.0);
        }
    }
    OutlineSpec bulging = dog_bone();  // more than half a circle: through a point that is farther out than the chord is long
    bulging.arcs = {{1, {0.28, 0.08}}};
    const double r = (0.08 * 0.08 + 0.2 * 0.2) / 0.4, cut = std::asin(0.08 / r),
                 beyond = r * r * (std::numbers::pi - cut + std::sin(cut) * std::cos(cut));
    EXPECT_NEAR(make_outline(bulging, {0.0003, 0.0003}).area_m2 / (0.08 * chord + beyond), 1.0, 1e-3);
}

TEST(Outline, ImpossibleArcsAreRefused) {
    const auto refused = [](const std::vector<ArcSpec>& arcs) {
        OutlineSpec spec = dog_bone();
        spec.arcs = arcs;
        try {
            make_outline(spec);
        } catch (const InputError& error) {
            return error.problem();
        }
        return std::string("accepted");
    };
    EXPECT_NE(refused({{7, {0.06, 0.08}}}).find("is on no edge"), std::string::npos);
    EXPECT_NE(refused({{1, {0.08, 0.05}}}).find("on the straight edge"), std::string::npos);
    EXPECT_NE(refused({{1, {0.06, 0.08}}, {1, {0.07, 0.08}}}).find("given twice"), std::string::npos);
    EXPECT_NE(refused({{2, {0.04, 0.17}}}).find("which is flat"), std::string::npos);
    EXPECT_NE(refused({{1, {0.03, 0.08}}, {3, {0.05, 0.08}}}).find("crosses or touches"), std::string::npos);
}

TEST(Outline, ImpossibleOutlinesAreRefused) {
    EXPECT_THROW(make_outline(rectangle(0.0, 0.16).outline), InputError);
    EXPECT_THROW(make_outline(rectangle(0.08, -1.0).outline), InputError);
    EXPECT_THROW(make_outline(rectangle(std::nan(""), 0.1).outline), InputError);
    EXPECT_THROW(make_outline(disc(0.0).outline), InputError);
    EXPECT_THROW(make_outline(polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).outline), InputError);
    EXPECT_THROW(make_outline(polygon({{0, 0}, {1, 1}}).outline), InputError);
    OutlineSpec labels = triangle().outline;
    labels.edge_labels = {"one"};
    EXPECT_THROW(make_outline(labels), InputError);
}

OutlineSpec labelled(std::vector<Vec2> vertices, std::vector<std::string> labels) {
    OutlineSpec spec;
    spec.shape = Shape::polygon;
    spec.vertices_m = std::move(vertices);
    spec.edge_labels = std::move(labels);
    return spec;
}

const std::vector<Vec2> upright = {{0, 0}, {0.02, 0}, {0.02, 0.04}, {0, 0.04}},
                        upright_clockwise = {{0, 0}, {0, 0.04}, {0.02, 0.04}, {0.02, 0}};

TEST(Outline, EndsOnTheirOwnSidesAreFineInEitherOrientation) {
    EXPECT_FALSE(end_fault(labelled(upright, {"bottom", "right", "top", "left"})));
    EXPECT_FALSE(end_fault(labelled(upright_clockwise, {"left", "top", "right", "bottom"})));
    EXPECT_FALSE(end_fault(labelled({{0, 0}, {0.02, 0.003}, {0.02, 0.04}, {0, 0.038}}, {"bottom", "right", "top", "left"})))
        << "8.5 degrees";
    EXPECT_FALSE(end_fault(labelled({{0, 0}, {0.01, 0}, {0.02, 0}, {0.02, 0.04}, {0.01, 0.04}, {0, 0.04}},
                                    {"bottom", "b", "right", "c", "top", "left"})))
        << "half of each side";
    EXPECT_FALSE(end_fault(labelled(upright, {"a", "b", "c", "d"}))) << "a specimen that no platen touches";
}

TEST(Outline, EndsOnTheWrongSidesAreRefused) {
    const auto problem = [](const OutlineSpec& spec) {
        EXPECT_THROW(make_outline(spec), InputError);
        const auto fault = end_fault(spec);
        return fault ? fmt::format("{}: {}", fault->edge, fault->problem) : std::string();
    };
    EXPECT_EQ(problem(labelled(upright, {"top", "right", "bottom", "left"})), "0: the label \"top\" lies below \"bottom\"");
    EXPECT_EQ(problem(labelled(upright_clockwise, {"left", "bottom", "right", "top"})),
              "3: the label \"top\" lies below \"bottom\"");
    EXPECT_EQ(problem(labelled(upright, {"left", "top", "right", "bottom"})).substr(0, 25), "1: the edge labelled \"top");
    EXPECT_NE(problem(labelled(upright, {"left", "top", "right", "bottom"})).find("90 degrees from horizontal"),
              std::string::npos);
    EXPECT_NE(problem(labelled({{0, 0}, {0.02, 0.004}, {0.02, 0.04}, {0, 0.04}}, {"bottom", "right", "top", "left"}))
                  .find("11 degrees"),
              std::string::npos);
    // both on the lower side
    EXPECT_EQ(problem(labelled({{0, 0}, {0.01, 0}, {0.02, 0}, {0.02, 0.04}, {0, 0.04}}, {"bottom", "top", "right", "c", "left"}))
                  .substr(0, 25),
              "1: the edge labelled \"top");
    // a step: the lower shoulder is called top, the rock above it bottom
    EXPECT_NE(problem(labelled({{0, 0}, {0.02, 0}, {0.02, 0.02}, {0.01, 0.02}, {0.01, 0.04}, {0, 0.04}},
                               {"top", "a", "bottom", "b", "c", "d"})),
              "");
}

TEST(Outline, SectionsAreMeasuredAcrossTheLoad) {
    const SectionWidths straight = section_widths(make_outline(rectangle(0.08, 0.16).outline));
    EXPECT_DOUBLE_EQ(straight.narrowest, 0.08);
    EXPECT_DOUBLE_EQ(straight.widest, 0.08);
    // a bone of 20 mm with a waist of 8 mm from 16 to 34 mm of its 50
    const Outline bone = make_outline(labelled({{0, 0},
                                                {0.020, 0},
                                                {0.020, 0.008},
                                                {0.014, 0.016},
                                                {0.014, 0.034},
                                                {0.020, 0.042},
                                                {0.020, 0.050},
                                                {0, 0.050},
                                                {0, 0.042},
                                                {0.006, 0.034},
                                                {0.006, 0.016},
                                                {0, 0.008}},
                                               {"bottom", "a", "b", "c", "d", "e", "top", "f", "g", "h", "i", "j"}));
    const SectionWidths waist = section_widths(bone);
    EXPECT_NEAR(waist.narrowest, 0.008, 1e-15);
    EXPECT_NEAR(waist.widest, 0.020, 1e-15);
    EXPECT_NEAR(waist.gauge_narrowest, 0.008, 1e-15);
    EXPECT_NEAR(waist.gauge_widest, 0.008 + 2.0 * 0.0035 * 6.0 / 8.0,
                1e-15);  // at a quarter of the height, 3.5 mm below the waist
    const SectionWidths tapered = section_widths(
        make_outline(labelled({{0, 0}, {0.02, 0}, {0.01, 0.04}, {0.005, 0.04}}, {"bottom", "right", "top", "left"})));
    EXPECT_NEAR(tapered.narrowest, 0.005, 1e-15);
    EXPECT_NEAR(tapered.widest, 0.020, 1e-15);
    // two legs of 5 mm count together; where an arm hangs down beside them, it does too
    EXPECT_NEAR(
        section_widths(make_outline(labelled(
                           {{0, 0}, {0.005, 0}, {0.005, 0.02}, {0.015, 0.02}, {0.015, 0}, {0.02, 0}, {0.02, 0.04}, {0, 0.04}},
                           {"bottom", "a", "b", "c", "bottom", "d", "top", "e"})))
            .narrowest,
        0.010, 1e-15);
}

}  // namespace
}  // namespace feldspar
