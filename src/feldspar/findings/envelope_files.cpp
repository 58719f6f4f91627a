// envelope.csv, envelope.json, envelope.html and the table of the envelope: one set of numbers, four ways to read it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "feldspar/base/printable.hpp"
#include "feldspar/base/text_table.hpp"
#include "feldspar/findings/envelope.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/html_page.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/study/report_json.hpp"
#include "feldspar/study/study_table.hpp"

namespace feldspar {

namespace {

/// Where a test stands in the plane of principal stresses (Pa, compression positive): direct tension at (-DTS, 0), the Brazilian
/// test at the stresses of an elastic disc's centre, (-BTS, 3 BTS).
struct StressState {
    double sigma3_Pa;
    double sigma1_Pa;
};

StressState state_of(const TestResult& result) {
    const double strength = result.properties.peak_stress_Pa;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto [least, most] = method_of(result.test).loading.failure_state.value_or(std::array{nan, nan});
    return {least * strength + result.test.sigma3_Pa, most * strength};
}

bool counts(const TestResult& result) {
    return result.properties.peak_reached && std::isfinite(result.properties.peak_stress_Pa);
}

Json tests_json(std::span<const TestResult> results) {
    Json list = Json::array();
    for (const TestResult& r : results) {
        const StressState state = state_of(r);
        list.push_back({{"test", name(r.test.kind)},
                        {"seed", r.seed},
                        {"sigma3_MPa", json_number(state.sigma3_Pa * MPa)},
                        {"sigma1_MPa", json_number(state.sigma1_Pa * MPa)},
                        {"strength_MPa", json_number(r.properties.peak_stress_Pa * MPa)},
                        {"peak_reached", r.properties.peak_reached},
                        {"grade", std::string(1, r.evidence.grade)},
                        {"verdict", r.evidence.verdict}});
    }
    return list;
}

Json strengths_json(const EnvelopeFits& fits) {
    Json list = Json::array();
    for (const StrengthAt& s : fits.strengths) {
        Json row = {{"sigma3_MPa", json_number(s.sigma3_Pa * MPa)}};
        row.update(interval_json(s.sigma1_Pa, MPa));
        row["mohr_coulomb_MPa"] = json_number(fits.joint.mohr_coulomb_at(s.sigma3_Pa) * MPa);
        row["hoek_brown_MPa"] = json_number(fits.joint.hoek_brown_at(s.sigma3_Pa) * MPa);
        list.push_back(row);
    }
    return list;
}

Json constants_json(const EnvelopeFits& fits) {
    Json list = Json::array();
    for (const EnvelopeConstant& c : fits.constants) {
        const UserQuantity quantity = user_quantity(c.property);
        Json row = quantity_json(quantity);
        row.update(interval_json(c.packings, quantity.factor));
        row["joint"] = json_number(c.joint * quantity.factor);
        list.push_back(row);
    }
    return list;
}

Json curves_json(const CurvePair& pair) {
    return {{"cohesion_MPa", json_number(pair.fit.cohesion_Pa * MPa)},
            {"friction_angle_deg", json_number(pair.fit.friction_angle_deg)},
            {"mohr_coulomb_N", json_number(pair.N)},
            {"UCS_fitted_MPa", json_number(pair.fit.UCS_fitted_Pa * MPa)},
            {"mohr_coulomb_tension_MPa", json_number(pair.mohr_coulomb_tension_Pa * MPa)},
            {"mohr_coulomb_rms_MPa", json_number(pair.mohr_coulomb.rms_Pa * MPa)},
            {"mohr_coulomb_R2", json_number(pair.mohr_coulomb.R2)},
            {"hoek_brown_mi", json_number(pair.fit.hoek_brown_mi)},
            {"hoek_brown_UCS_MPa", json_number(pair.fit.hoek_brown_UCS_Pa * MPa)},
            {"hoek_brown_tension_MPa", json_number(pair.hoek_brown_tension_Pa * MPa)},
            {"hoek_brown_rms_MPa", json_number(pair.hoek_brown.rms_Pa * MPa)},
            {"hoek_brown_R2", json_number(pair.hoek_brown.R2)}};
}

Json judgement_json(const CurveJudgement& judgement) {
    return {{"misfit_MPa", json_number(judgement.misfit_Pa * MPa)},
            {"means_within_interval", judgement.through},
            {"means_with_interval", judgement.judged}};
}

Json measured_json(const EnvelopeFits& fits) {
    Json list = Json::array();
    const auto add = [&](const std::string& property, const MeanInterval& interval) {
        Json row = quantity_json(user_quantity(property));
        row.update(interval_json(interval, MPa));
        list.push_back(row);
    };
    add("UCS_Pa", fits.UCS_measured);
    for (const TensileStrength& t : fits.tension) add(t.property, t.measured);
    return list;
}

Json envelope_json(const PointResults& point, bool with_tension) {
    const EnvelopeFits fits = fit_series(point.results, with_tension);
    Json packings = Json::array();
    for (const CurvePair& pair : fits.packings) {
        Json row = {{"seed", pair.fit.seed}};
        row.update(curves_json(pair));
        packings.push_back(row);
    }
    return {{"variant", point_label(point)},
            {"method", fits.method},
            {"verdict", fits.verdict},
            {"with_tension", fits.with_tension},
            {"constants", constants_json(fits)},
            {"measured", measured_json(fits)},
            {"strengths", strengths_json(fits)},
            {"joint", curves_json(fits.joint)},
            {"packings", packings},
            {"mohr_coulomb", judgement_json(fits.mohr_coulomb)},
            {"hoek_brown", judgement_json(fits.hoek_brown)},
            {"scatter_MPa", json_number(fits.scatter_Pa * MPa)},
            {"grades", grades_json(point.results)},
            {"missing", point.missing},
            {"tests", tests_json(point.results)}};
}

/// The laboratory's points and what its line needs.
Json laboratory_with_points(const Job& job) {
    Json json = laboratory_json(job);
    json["confined"] = Json::array();
    for (const ConfinedStrength& c : job.laboratory_confined)
        json["confined"].push_back({json_number(c.sigma3_Pa * MPa), json_number(c.sigma1_Pa * MPa)});
    return json;
}

Json whole_json(const Study& study, std::span<const PointResults> points, bool with_tension, const Provenance& provenance) {
    Json envelopes = Json::array();
    for (const PointResults& point : points) envelopes.push_back(envelope_json(point, with_tension));
    const Job& job = study.points.front().job;
    return {{"title", study.title},
            {"job", {{"name", job.name}, {"file", job.file.string()}, {"seeds", job.seeds}}},
            {"signs", "compression positive; strengths are positive magnitudes"},
            {"missing", missing_runs(points)},
            {"envelopes", envelopes},
            {"laboratory", laboratory_with_points(job)},
            {"failures", failures_json(points)},
            {"provenance", provenance_json(provenance)}};
}

std::string csv(const Study& study, std::span<const PointResults> points, const Provenance& provenance) {
    std::string text = fmt::format(
        "# {}: strengths of all tests\n# signs: compression positive; sigma3 and sigma1: direct tension (-DTS, 0), Brazilian "
        "test (-BTS, 3 BTS) as at the centre "
        "of an elastic disc\n# feldspar {}, commit {}\n# columns: variant; test; seed of the packing; sigma3 [MPa]; sigma1 "
        "[MPa]; strength [MPa], a positive "
        "magnitude; peak_reached 1 or 0 (then the strength is a lower bound and is in no fit); grade of the quasi-static "
        "evidence\n"
        "variant,test,seed,sigma3_MPa,sigma1_MPa,strength_MPa,peak_reached,grade\n",
        printable(study.title, LineEnds::escaped), provenance.version, provenance.commit);
    for (const PointResults& point : points)
        for (const TestResult& r : point.results) {
            const StressState state = state_of(r);
            text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_cell(point_label(point)), name(r.test.kind), r.seed,
                                csv_number(state.sigma3_Pa * MPa), csv_number(state.sigma1_Pa * MPa),
                                csv_number(r.properties.peak_stress_Pa * MPa), counts(r) ? 1 : 0, r.evidence.grade);
        }
    return text;
}

std::string interval_text(const MeanInterval& interval, double factor) {
    return interval.count < 2
               ? "-"
               : fmt::format("{} .. {}", table_number(interval.low * factor), table_number(interval.high * factor));
}

std::string strength_table(const EnvelopeFits& fits, std::size_t columns) {
    std::vector<Row> rows{{"sigma_3 MPa", "sigma_1 MPa", "95 % interval", "n", "line", "parabola"}};
    for (const StrengthAt& s : fits.strengths)
        rows.push_back({fmt::format("{:g}", s.sigma3_Pa * MPa), table_number(s.sigma1_Pa.mean * MPa),
                        interval_text(s.sigma1_Pa, MPa), std::to_string(s.sigma1_Pa.count),
                        table_number(fits.joint.mohr_coulomb_at(s.sigma3_Pa) * MPa),
                        table_number(fits.joint.hoek_brown_at(s.sigma3_Pa) * MPa)});
    return aligned(rows, 0, columns);
}

std::string constant_table(const Job& job, const EnvelopeFits& fits, std::size_t columns) {
    std::vector<Row> rows{{"Constant", "unit", "mean", "95 % interval", "n", "joint fit", "laboratory"}};
    const auto laboratory = [&](const std::string& property) -> std::string {
        for (const auto& [key, value] : job.laboratory)
            if (property_of_laboratory(key) == property) return table_number(laboratory_in_user_units(key, value));
        return "";
    };
    const auto add = [&](const std::string& property, const MeanInterval& interval, const std::string& joint) {
        const UserQuantity quantity = user_quantity(property);
        rows.push_back({quantity.label, quantity.unit, table_number(interval.mean * quantity.factor),
                        interval_text(interval, quantity.factor), std::to_string(interval.count), joint, laboratory(property)});
    };
    for (const EnvelopeConstant& c : fits.constants)
        add(c.property, c.packings, table_number(c.joint * user_quantity(c.property).factor));
    add("UCS_Pa", fits.UCS_measured, "measured");
    for (const TensileStrength& t : fits.tension) add(t.property, t.measured, "measured");
    return aligned(rows, 2, columns, 2);
}

std::string goodness_table(const CurvePair& joint, std::size_t columns) {
    const auto R2 = [](double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : std::string("-"); };
    return aligned({{"Joint fit", "rms residual MPa", "R2"},
                    {"Mohr-Coulomb line", table_number(joint.mohr_coulomb.rms_Pa * MPa), R2(joint.mohr_coulomb.R2)},
                    {"Hoek-Brown parabola", table_number(joint.hoek_brown.rms_Pa * MPa), R2(joint.hoek_brown.R2)}},
                   1, columns);
}

std::string grades_text(std::span<const TestResult> results) {
    const Json grades = grades_json(results);
    return fmt::format("Quasi-static: {} runs of grade A, {} B, {} C (strength not shown to be that of slow loading).\n",
                       grades["A"].get<int>(), grades["B"].get<int>(), grades["C"].get<int>());
}

}  // namespace

void write_envelope(const std::filesystem::path& directory, const Study& study, std::span<const PointResults> points,
                    bool with_tension, const Provenance& provenance) {
    const Json json = whole_json(study, points, with_tension, provenance);
    write_beside(directory / "envelope.csv", csv(study, points, provenance));
    write_beside(directory / "envelope.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    write_beside(directory / "envelope.html", html_page(study.title, json, asset_envelope_js));
}

std::string envelope_text(const Study& study, std::span<const PointResults> points, bool with_tension, std::size_t columns) {
    std::string text;
    for (const PointResults& point : points) {
        if (!text.empty()) text += "\n";
        if (!point_label(point).empty()) text += point_label(point) + "\n\n";
        const EnvelopeFits fits = fit_series(point.results, with_tension);
        if (fits.strengths.empty()) {
            text += "No compression test has reached its peak.\n";
            continue;
        }
        text += strength_table(fits, columns) + "\n" + constant_table(study.points.front().job, fits, columns) + "\n" +
                goodness_table(fits.joint, columns) + "\n";
        text += wrapped_text(fits.verdict, {}, columns) + wrapped_text(grades_text(point.results), {}, columns) +
                wrapped_text(fits.method, {}, columns);
    }
    return text;
}

}  // namespace feldspar
