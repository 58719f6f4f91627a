#include "feldspar/live/live_stream.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "feldspar/live/live_test.hpp"
#include "feldspar/output/report_data.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
std::string packed(const std::vector<Number>& values) {
    return base64({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Number)});
}

Json progress_json(const TestProgress& p) {
    return {{"stage", p.stage},
            {"strain", rounded(p.axial_strain * 1e3)},
            {"stress", rounded(p.axial_stress_Pa * 1e-6)},
            {"peak", rounded(p.peak_stress_Pa * 1e-6)},
            {"cracks", p.cracks},
            {"step", p.step},
            {"steps_per_second", rounded(p.steps_per_second)},
            {"seconds_left", p.seconds_left >= 0.0 && std::isfinite(p.seconds_left) ? rounded(p.seconds_left) : Json(nullptr)}};
}

// A column of a list of things.
template <class Thing, class Value>
Json column(const std::vector<Thing>& list, Value Thing::*member) {
    Json values = Json::array();
    for (const Thing& thing : list) {
        if constexpr (std::is_floating_point_v<Value>)
            values.push_back(rounded(thing.*member));
        else
            values.push_back(static_cast<int>(thing.*member));
    }
    return values;
}

// Corners of the grains, undeformed.
Json outline_json(const GrainMesh& mesh) {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high{-low.x, -low.y};
    for (const Vec2 node : mesh.nodes) {
        low = {std::min(low.x, node.x), std::min(low.y, node.y)};
        high = {std::max(high.x, node.x), std::max(high.y, node.y)};
    }
    const double step = std::max({high.x - low.x, high.y - low.y, 1e-12}) / 65535.0;
    std::vector<int> begin{0};
    std::vector<std::uint16_t> points;
    for (std::size_t g = 0; g < mesh.vertex_count.size(); ++g) {
        for (int k = 0; k < mesh.vertex_count[g]; ++k) {
            const Vec2 node = mesh.nodes[static_cast<std::size_t>(mesh.node_begin[g] + k)];
            for (const double steps : {(node.x - low.x) / step, (node.y - low.y) / step})
                points.push_back(static_cast<std::uint16_t>(std::lround(steps)));
        }
        begin.push_back(static_cast<int>(points.size() / 2));
    }
    return {{"x0", low.x * 1e3},
            {"y0", low.y * 1e3},
            {"scale", step * 1e3},
            {"width", (high.x - low.x) * 1e3},
            {"height", (high.y - low.y) * 1e3},
            {"begin", packed(begin)},
            {"points", packed(points)}};
}

}  // namespace

const char* name(LiveState state) {
    switch (state) {
        case LiveState::waiting:
            return "waiting";
        case LiveState::running:
            return "running";
        case LiveState::writing:
            return "writing";
        case LiveState::ended:
            return "ended";
        case LiveState::failed:
            return "failed";
    }
    return "";
}

LiveStream::LiveStream(LiveBoard& board) : board_(board) { board_.looked_at(true); }

LiveStream::~LiveStream() { board_.looked_at(false); }

std::string LiveStream::next(std::chrono::milliseconds at_most) {
    const bool first = version_ == 0;
    if (!first && board_.wait(version_, at_most) == version_) return {};
    // Under the lock only what is new is copied; the text is made behind it.
    struct News {
        std::size_t n = 0;
        LiveBoard::Test copy;  // of what is new, and without its watch
        std::shared_ptr<const Specimen> specimen;
        std::size_t points_from = 0, cracks_from = 0;
        bool curve = false, cracks = false, frame = false;
    };
    std::vector<News> news;
    Json run;
    const double cost = board_.cost();
    {
        const std::lock_guard lock(board_.mutex_);
        version_ = board_.version_;
        seen_.resize(board_.tests_.size());
        int ended = 0, failed = 0, running = 0;
        for (std::size_t n = 0; n < board_.tests_.size(); ++n) {
            const LiveBoard::Test& test = *board_.tests_[n];
            Seen& seen = seen_[n];
            ended += test.state == LiveState::ended;
            failed += test.state == LiveState::failed;
            running += test.state == LiveState::running;
            if (test.version <= seen.version) continue;
            seen.version = test.version;
            News& one = news.emplace_back();
            one.n = n;
            one.copy.plan = test.plan;
            one.copy.state = test.state;
            one.copy.words = test.words;
            one.copy.progress = test.progress;
            if (test.state == LiveState::ended || test.state == LiveState::failed) continue;
            if (test.curve_round != seen.curve_round) seen.points = 0;
            if (test.crack_round != seen.crack_round) seen.cracks = 0;
            one.curve = test.curve_round != seen.curve_round || test.curve.size() > seen.points;
            one.cracks = test.crack_round != seen.crack_round || test.cracks.size() > seen.cracks;
            seen.curve_round = test.curve_round;
            seen.crack_round = test.crack_round;
            one.points_from = std::exchange(seen.points, test.curve.size());
            one.cracks_from = std::exchange(seen.cracks, test.cracks.size());
            one.copy.curve.assign(test.curve.begin() + static_cast<std::ptrdiff_t>(one.points_from), test.curve.end());
            one.copy.cracks.assign(test.cracks.begin() + static_cast<std::ptrdiff_t>(one.cracks_from), test.cracks.end());
            if (!seen.outline && test.specimen && test.specimen->mesh.vertex_count.size() <= kMostShownGrains)
                one.specimen = test.specimen;
            seen.outline = seen.outline || test.specimen;
            one.frame = test.frame && test.frame != seen.frame;
            one.copy.frame = seen.frame = test.frame;
        }
        const double left = board_.seconds_left();
        run = {{"name", board_.name_},
               {"busy", board_.busy_},
               {"tests", std::max(board_.tests_.size(), board_.most_)},
               {"at_most", board_.most_ > board_.tests_.size()},
               {"running", running},
               {"ended", ended},
               {"failed", failed},
               {"seconds_left", left >= 0.0 ? rounded(left) : Json(nullptr)},
               {"reports", board_.reports_},
               {"over", board_.over_ ? Json(board_.over_words_) : Json(nullptr)},
               {"ending", board_.ending_},
               {"cost", rounded(cost)}};
        at_end_ = board_.over_;
    }
    Json tests = Json::array();
    for (const News& one : news) {
        const LiveBoard::Test& test = one.copy;
        Json json = {{"n", one.n}, {"label", test.plan.label}, {"state", name(test.state)}, {"words", test.words}};
        if (test.progress) json["progress"] = progress_json(*test.progress);
        if (!std::exchange(seen_[one.n].axes, true))
            json["axes"] = {{"stress", test.plan.stress_axis}, {"strain", test.plan.strain_axis}};
        if (one.curve)
            json["curve"] = {{"from", one.points_from},
                             {"strain", column(test.curve, &LivePoint::strain)},
                             {"stress", column(test.curve, &LivePoint::stress)},
                             {"tensile", column(test.curve, &LivePoint::tensile)},
                             {"shear", column(test.curve, &LivePoint::shear)}};
        if (one.cracks)
            json["cracks"] = {{"from", one.cracks_from},
                              {"x0", column(test.cracks, &LiveCrack::x0)},
                              {"y0", column(test.cracks, &LiveCrack::y0)},
                              {"x1", column(test.cracks, &LiveCrack::x1)},
                              {"y1", column(test.cracks, &LiveCrack::y1)},
                              {"mode", column(test.cracks, &LiveCrack::mode)},
                              {"a", column(test.cracks, &LiveCrack::grain_a)},
                              {"b", column(test.cracks, &LiveCrack::grain_b)}};
        if (one.specimen) json["outline"] = outline_json(one.specimen->mesh);
        if (one.frame) json["frame"] = {{"scale", test.frame->scale_mm}, {"steps", packed(test.frame->steps)}};
        tests.push_back(std::move(json));
    }
    return Json{{"run", std::move(run)}, {"tests", std::move(tests)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace feldspar
