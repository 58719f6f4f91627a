// Studies and calibrations.
#include <fmt/format.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/calibration/calibration_report.hpp"
#include "feldspar/findings/claims.hpp"
#include "feldspar/findings/converge.hpp"
#include "feldspar/findings/envelope.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_report.hpp"
#include "feldspar/study/study_table.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

std::string read_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw OutputError(fmt::format("'{}' cannot be read again", file.string()));
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string label_of_run(const Run& run) { return fmt::format("{}, seed {}", title(run.test()), run.seed()); }

std::string label_of_run(const Study& study, const Run& run) {
    std::string text;
    for (const AxisValue& value : study.points[run.point].values) text += (text.empty() ? "" : ", ") + value.label;
    return text + (text.empty() ? "" : ": ") + label_of_run(run);
}

// Tells a function of Python of runs; none may be given.
class RunTeller {
public:
    RunTeller(OnCaller& caller, py::object function)
        : caller_(caller), function_(std::move(function)), silent_(function_.is_none()) {}

    void tell(const char* event, const std::string& text, int number = 0, int count = 0) const {
        if (silent_) return;
        (void)caller_.call([&] {
            py::dict d;
            d["event"] = event;
            d["text"] = text;
            if (count > 0) {
                d["number"] = number;
                d["count"] = count;
            }
            function_(d);
        });
    }
    static std::string ended(const std::string& label, const RunRecord& record) {
        if (record.state == RunState::failed) return fmt::format("{}: failed: {}", label, record.reason);
        return fmt::format("{}: {:.4g} MPa, grade {}", label, record.numbers.at("strength_Pa") * MPa, record.texts.at("grade"));
    }
    bool silent() const { return silent_; }

private:
    OnCaller& caller_;
    py::object function_;
    bool silent_;
};

// How runs are to be made, and who is told of them.
struct Making {
    int threads = 0, at_once = 0;
    bool retry_failed = false;
    py::object progress;
};

// Runs what is not done yet of a study, then writes what is made of it. @param maker  "feldspar.envelope()", for provenance
Execution make_runs(const Study& study, const Making& making, const char* maker, bool& interrupted,
                    const std::function<void(const std::vector<PointResults>&, const Provenance&)>& write) {
    const int all_threads = threads_of(making.threads);
    OnCaller caller;
    const RunTeller teller(caller, making.progress);
    std::atomic<bool> stop{false};
    Execution execution;
    caller.run(
        [&] {
            Ledger ledger(study.results, Ledger::Access::write);
            ledger.enrol(study);
            ExecuteControl control;
            control.threads = all_threads;
            control.at_once = making.at_once;
            control.keep = study.keep;
            control.retry_failed = making.retry_failed;
            control.stop = &stop;
            control.provenance = collect_provenance(maker, all_threads);
            int number = 0;
            const int count = static_cast<int>(study.runs.size());
            if (!teller.silent())
                control.ended = [&](const Run& run, const RunRecord& record) {
                    teller.tell("finished", RunTeller::ended(label_of_run(study, run), record), ++number, count);
                };
            control.note = [&](const std::string& line) { teller.tell("note", line); };
            execution = execute(study.runs, ledger, control);
            write(point_results(study, ledger), control.provenance);
        },
        [&] { stop = true; });
    interrupted = caller.interrupted();
    return execution;
}

py::dict counts_of(const Execution& execution) {
    py::dict d;
    d["found_done"] = execution.found_done;
    d["found_failed"] = execution.found_failed;
    d["done"] = execution.done;
    d["failed"] = execution.failed;
    d["left"] = execution.left;
    d["run_s"] = execution.run_s;
    d["wall_s"] = execution.wall_s;
    return d;
}

py::dict run_study(const Study& study, int threads, int at_once, bool retry_failed, const py::object& progress) {
    bool interrupted = false;
    const Execution execution = make_runs(study, {threads, at_once, retry_failed, progress}, "feldspar.run_study()", interrupted,
                                          [&](const std::vector<PointResults>& points, const Provenance&) {
                                              write_study_report(study, points, study_page(study));
                                          });
    const py::dict counts = counts_of(execution);
    if (interrupted) raise_interrupted(counts);
    return counts;
}

// What a study of a job has left: its counts, directory and page, and the text of its JSON file.
py::tuple findings(const Study& study, const Execution& execution, bool interrupted, const char* name) {
    py::dict d;
    d["directory"] = study.results.string();
    d["page"] = (study.results / fmt::format("{}.html", name)).string();
    d["executed"] = counts_of(execution);
    if (interrupted) raise_interrupted(d);
    return py::make_tuple(d, read_text(study.results / fmt::format("{}.json", name)));
}

void tell_remarks(const std::vector<std::string>& remarks, const py::object& progress) {
    if (progress.is_none()) return;
    for (const std::string& remark : remarks) {
        py::dict d;
        d["event"] = "note";
        d["text"] = remark;
        progress(d);
    }
}

py::tuple run_envelope(const Job& job, std::optional<int> seeds, const py::list& sigma3, bool with_tension,
                       const std::optional<std::string>& results, int threads, int at_once, bool retry_failed,
                       const py::object& progress) {
    EnvelopeOptions options;
    options.seeds = seeds;
    for (const py::handle& one : sigma3) {
        options.sigma3_Pa.push_back(quantity_of(py::reinterpret_borrow<py::object>(one), Dimension::stress, "sigma3"));
        if (!(options.sigma3_Pa.back() > 0.0))
            throw InputError({.key = "sigma3"}, "confines nothing",
                             "stresses greater than zero; the uniaxial test is always there");
    }
    options.with_tension = with_tension;
    if (results) options.results = *results;
    const EnvelopePlan plan = plan_envelope(job, options);
    tell_remarks(plan.remarks, progress);
    bool interrupted = false;
    const Execution execution =
        make_runs(plan.study, {threads, at_once, retry_failed, progress}, "feldspar.envelope()", interrupted,
                  [&](const std::vector<PointResults>& points, const Provenance& provenance) {
                      write_envelope(plan.study.results, plan.study, points, with_tension, provenance);
                  });
    return findings(plan.study, execution, interrupted, "envelope");
}

py::tuple run_convergence(const Job& job, std::optional<int> seeds, std::vector<std::string> tests, double within,
                          const std::optional<std::string>& results, int threads, int at_once, bool retry_failed,
                          const py::object& progress) {
    if (!(within > 0.0 && within < 1.0))
        throw InputError({.key = "within"}, fmt::format("{} is no change that does not matter", within),
                         "more than 0, less than 1");
    ConvergeOptions options;
    options.seeds = seeds;
    for (std::string& test : tests)
        if (const auto method = find_method_called(test)) test = name(*method);
    options.tests = std::move(tests);
    options.within = within;
    if (results) options.results = *results;
    const ConvergePlan plan = plan_convergence(job, options);
    tell_remarks(plan.remarks, progress);
    bool interrupted = false;
    const Execution execution =
        make_runs(plan.study, {threads, at_once, retry_failed, progress}, "feldspar.converge()", interrupted,
                  [&](const std::vector<PointResults>& points, const Provenance& provenance) {
                      write_convergence(plan.study.results, plan, points, provenance);
                  });
    return findings(plan.study, execution, interrupted, "converge");
}

py::list claims(const std::string& folder, const std::optional<std::string>& place) {
    const ClaimList list = read_claims(folder);
    StudiesByName studies = read_studies(list);
    if (place)
        for (auto& [stem, results] : studies) results.study.results = *place;
    add_results(studies);
    py::list found;
    for (const Claim& claim : list.claims) {
        const ClaimResult result = evaluate(claim, studies);
        py::list statements;
        for (const StatementResult& one : result.statements) {
            py::list comparisons;
            for (const Comparison& comparison : one.comparisons) {
                py::dict c;
                c["what"] = comparison.what;
                c["unit"] = comparison.unit;
                c["mean"] = number_or_none(comparison.interval.mean);
                c["low"] = number_or_none(comparison.interval.low);
                c["high"] = number_or_none(comparison.interval.high);
                c["packings"] = comparison.interval.count;
                c["verdict"] = name(comparison.verdict);
                comparisons.append(c);
            }
            py::dict s;
            s["says"] = one.statement.says;
            s["study"] = one.study;
            s["verdict"] = name(one.verdict);
            s["votes"] = one.votes;
            s["runs"] = one.runs;
            s["missing"] = one.missing;
            s["failed"] = one.failed;
            s["comparisons"] = comparisons;
            statements.append(s);
        }
        py::dict d;
        d["id"] = claim.id;
        d["figure"] = claim.figure;
        d["says"] = claim.says;
        d["verdict"] = name(result.verdict);
        d["statements"] = statements;
        found.append(d);
    }
    return found;
}

py::dict status_of(const Study& study) {
    std::set<std::string> ids;
    for (const Run& run : study.runs) ids.insert(run.id);
    std::map<RunState, int> counts;
    py::list failures;
    if (std::filesystem::exists(study.results / "ledger.sqlite"))
        for (const RunRecord& record :
             Ledger(study.results, Ledger::Access::read).find(std::vector<std::string>(ids.begin(), ids.end()))) {
            ++counts[record.state];
            if (record.state == RunState::failed) {
                py::dict d;
                d["test"] = record.test;
                d["sigma3_MPa"] = record.sigma3_Pa * MPa;
                d["seed"] = record.seed;
                d["reason"] = record.reason;
                failures.append(d);
            }
        }
    py::dict d;
    d["runs"] = ids.size();
    d["done"] = counts[RunState::done];
    d["running"] = counts[RunState::running];
    d["failed"] = counts[RunState::failed];
    d["left"] = static_cast<int>(ids.size()) - counts[RunState::done] - counts[RunState::running] - counts[RunState::failed];
    d["failures"] = failures;
    return d;
}

std::string run_calibration(const std::string& file, const std::optional<std::string>& results, std::optional<int> budget,
                            int threads, int at_once, bool insist, const py::object& progress,
                            const std::vector<std::string>& settings) {
    Calibration calibration = read_calibration(file, settings);
    if (results) calibration.results = *results;
    if (budget) calibration.budget = *budget;
    const std::vector<std::string> contradicting = contradictions(calibration.targets);
    if (!contradicting.empty() && !insist) {
        std::string text = "the targets contradict each other, so no run was made";
        for (const std::string& sentence : contradicting) text += "; " + sentence;
        throw InputError({file, 0, 0, "targets"}, text, "targets of one rock, or insist=True to see how near one can come");
    }
    check_budget(calibration);
    OnCaller caller;
    const RunTeller teller(caller, progress);
    for (const std::string& sentence : contradicting)
        if (!teller.silent()) {
            py::dict d;
            d["event"] = "note";
            d["text"] = sentence;
            progress(d);
        }
    std::atomic<bool> stop{false};
    std::string json;
    const int all_threads = threads_of(threads);
    bool complete = false;
    caller.run(
        [&] {
            Ledger ledger(calibration.results, Ledger::Access::write);
            ExecuteControl control;
            control.threads = all_threads;
            control.at_once = at_once;
            control.keep = Keep::numbers;
            control.stop = &stop;
            control.provenance = collect_provenance("feldspar.calibrate()", all_threads);
            const RunLaboratory* running = nullptr;
            if (!teller.silent())
                control.ended = [&](const Run& run, const RunRecord& record) {
                    teller.tell("finished", RunTeller::ended(label_of_run(run), record), running->number_of(run),
                                calibration.budget);
                };
            control.note = [&](const std::string& line) { teller.tell("note", line); };
            RunLaboratory laboratory(calibration, ledger, control);
            running = &laboratory;
            const CalibrationResult result =
                calibrate(calibration, laboratory, [&](const std::string& line) { teller.tell("note", line); });
            complete = result.complete;
            if (!complete) return;
            json = calibration_json(calibration, result, control.provenance);
            const RunDirectory directory = RunDirectory::open(calibration.results);
            directory.write_text("calibration.json", json);
            directory.write_text("calibrated.toml", calibrated_job(calibration, result));
            write_calibration_report(calibration, result, control.provenance, calibration_page(calibration));
        },
        [&] { stop = true; });
    if (caller.interrupted() || !complete) raise_interrupted(py::none());
    return json;
}

}  // namespace

void bind_studies(py::module_& m) {
    py::class_<Study>(m, "Study", "A study: one job, varied along axes, on several packings. Read by :meth:`read`.")
        .def_static(
            "read",
            [](const std::string& file, const std::optional<std::string>& results, const std::vector<std::string>& settings) {
                Study study = read_study(file, settings);
                if (results) study.results = *results;
                return study;
            },
            py::arg("file"), py::arg("results") = py::none(), py::arg("settings") = std::vector<std::string>{},
            "Reads and checks a study file. results: directory of ledger and runs in place of the file's. settings: "
            "\"key=value\", over the job, the study's [set] and its axes; a key that an axis varies is refused. Raises "
            "InputError.")
        .def_property_readonly(
            "name", [](const Study& s) { return s.name; }, "Name of the study.")
        .def_property_readonly(
            "title", [](const Study& s) { return s.title; }, "Its title.")
        .def_property_readonly(
            "results", [](const Study& s) { return s.results.string(); }, "Directory of its ledger and runs.")
        .def_property_readonly(
            "page", [](const Study& s) { return study_page(s).string(); }, "The page that is written when it has been run.")
        .def_property_readonly(
            "axes", [](const Study& s) { return s.axes; }, "Names of its axes.")
        .def_property_readonly(
            "points",
            [](const Study& s) {
                py::list list;
                for (const Point& point : s.points) {
                    std::vector<std::string> labels;
                    for (const AxisValue& value : point.values) labels.push_back(value.label);
                    list.append(py::cast(labels));
                }
                return list;
            },
            "Its points: the label of the value on each axis.")
        .def("__len__", [](const Study& s) { return s.runs.size(); })
        .def("status", &status_of,
             "How far it is, from its ledger: runs, done, running (or left behind by a process that is gone), failed, left, and "
             "failures: test, sigma3_MPa, seed and reason of each. Runs nothing.")
        .def(
            "results_json",
            [](const Study& s) { return study_json(s, point_results(s, Ledger(s.results, Ledger::Access::read))); },
            "JSON text, the points with their properties: what `feldspar study --json` prints of them.")
        .def("run", &run_study, py::kw_only(), py::arg("threads") = 0, py::arg("at_once") = 0, py::arg("retry_failed") = false,
             py::arg("progress") = py::none(),
             R"(Runs what is not done yet, and writes the page of the study. Goes on where it was interrupted.

threads: of all runs together, 0 for as many as there are cores; at_once: runs side by side, 0 as suits their size; retry_failed: also runs that failed for good; progress: called with a dictionary when a
run has ended (event, text, number, count). Returns counts: found_done, found_failed, done, failed, left, and run_s and wall_s. Raises OutputError, Interrupted with the same counts.)")
        .def(
            "points_csv", [](const Study& s) { return points_csv(s, point_results(s, Ledger(s.results, Ledger::Access::read))); },
            "CSV text, a row a point: means, bounds of the 95 % intervals and number of packings, user units.")
        .def(
            "runs_csv", [](const Study& s) { return runs_csv(s, Ledger(s.results, Ledger::Access::read)); },
            "CSV text, a row a run, SI units.")
        .def("__repr__", [](const Study& s) {
            return fmt::format("<feldspar.Study '{}': {} points, {} runs>", s.name, s.points.size(), s.runs.size());
        });

    m.def("run_calibration", &run_calibration, py::arg("file"), py::kw_only(), py::arg("results") = py::none(),
          py::arg("budget") = py::none(), py::arg("threads") = 0, py::arg("at_once") = 0, py::arg("insist") = false,
          py::arg("progress") = py::none(), py::arg("settings") = std::vector<std::string>{},
          "Runs a calibration and returns calibration.json as text; feldspar.calibrate() is the convenient form, which explains "
          "the arguments.");
    m.def(
        "run_envelope", &run_envelope, py::arg("job"), py::kw_only(), py::arg("seeds") = py::none(),
        py::arg("sigma3") = py::list(), py::arg("with_tension") = false, py::arg("results") = py::none(), py::arg("threads") = 0,
        py::arg("at_once") = 0, py::arg("retry_failed") = false, py::arg("progress") = py::none(),
        "Runs the tests of a strength envelope and returns what was done, and envelope.json as text; feldspar.envelope() is the "
        "convenient form, which explains the arguments.");
    m.def("run_convergence", &run_convergence, py::arg("job"), py::kw_only(), py::arg("seeds") = py::none(),
          py::arg("tests") = std::vector<std::string>{}, py::arg("within") = 0.05, py::arg("results") = py::none(),
          py::arg("threads") = 0, py::arg("at_once") = 0, py::arg("retry_failed") = false, py::arg("progress") = py::none(),
          "Runs the tests of a convergence and returns what was done, and converge.json as text; feldspar.converge() is the "
          "convenient form, which explains the arguments.");
    m.def("claims", &claims, py::arg("folder"), py::kw_only(), py::arg("results") = py::none(),
          "Holds the claims of a folder against its studies' ledgers; feldspar.claims() is the convenient form, which explains "
          "what comes back.");
}

}  // namespace feldspar::python
