// Studies and calibrations.
#include <fmt/format.h>

#include <atomic>

#include "feldspar/base/error.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/calibration/calibration_files.hpp"
#include "feldspar/calibration/calibration_report.hpp"
#include "feldspar/study/execute.hpp"
#include "feldspar/study/point_results.hpp"
#include "feldspar/study/study_report.hpp"
#include "feldspar/study/study_table.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

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

py::dict run_study(const Study& study, int threads, int at_once, bool retry_failed, const py::object& progress) {
    const int all_threads = threads_of(threads);
    OnCaller caller;
    const RunTeller teller(caller, progress);
    std::atomic<bool> stop{false};
    Execution execution;
    caller.run(
        [&] {
            Ledger ledger(study.results, Ledger::Access::write);
            ledger.enrol(study);
            ExecuteControl control;
            control.threads = all_threads;
            control.at_once = at_once;
            control.keep = study.keep;
            control.retry_failed = retry_failed;
            control.stop = &stop;
            control.provenance = collect_provenance("feldspar.run_study()", all_threads);
            int number = 0;
            const int count = static_cast<int>(study.runs.size());
            if (!teller.silent())
                control.ended = [&](const Run& run, const RunRecord& record) {
                    teller.tell("finished", RunTeller::ended(label_of_run(study, run), record), ++number, count);
                };
            control.note = [&](const std::string& line) { teller.tell("note", line); };
            execution = execute(study.runs, ledger, control);
            write_study_report(study, point_results(study, ledger), study_page(study));
        },
        [&] { stop = true; });
    py::dict d;
    d["found_done"] = execution.found_done;
    d["found_failed"] = execution.found_failed;
    d["done"] = execution.done;
    d["failed"] = execution.failed;
    d["left"] = execution.left;
    d["run_s"] = execution.run_s;
    d["wall_s"] = execution.wall_s;
    if (caller.interrupted()) raise_interrupted(d);
    return d;
}

std::string run_calibration(const std::string& file, const std::optional<std::string>& results, std::optional<int> budget,
                            int threads, int at_once, bool insist, const py::object& progress) {
    Calibration calibration = read_calibration(file);
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
            [](const std::string& file, const std::optional<std::string>& results) {
                Study study = read_study(file);
                if (results) study.results = *results;
                return study;
            },
            py::arg("file"), py::arg("results") = py::none(),
            "Reads and checks a study file. results: directory of ledger and runs in place of the file's. Raises InputError.")
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
          py::arg("progress") = py::none(),
          "Runs a calibration and returns calibration.json as text; feldspar.calibrate() is the convenient form, which explains "
          "the arguments.");
}

}  // namespace feldspar::python
