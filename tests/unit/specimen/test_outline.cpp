// From the user's outline to one ready for use.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace feldspar
