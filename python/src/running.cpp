// Tests and jobs, run.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/base/quantity_unit.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/run_job.hpp"
#include "feldspar/study/schedule.hpp"
#include "observers.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

py::dict progress_dict(const TestProgress& p) {
    py::dict d;
    d["event"] = "progress";
    d["stage"] = p.stage;
    d["step"] = p.step;
    d["axial_strain"] = p.axial_strain;
    d["axial_stress_MPa"] = p.axial_stress_Pa * MPa;
    d["peak_stress_MPa"] = p.peak_stress_Pa * MPa;
    d["cracks"] = p.cracks;
    d["steps_per_second"] = p.steps_per_second;
    d["seconds_left"] = p.seconds_left >= 0.0 ? py::object(py::float_(p.seconds_left)) : py::object(py::none());
    return d;
}

// Tells a function of Python how far work is; none may be given.
class Teller {
public:
    Teller(OnCaller& caller, py::object function)
        : caller_(caller), function_(std::move(function)), silent_(function_.is_none()) {}

    /// @param fill  puts into a dictionary what is told
    void tell(const std::function<void(py::dict&)>& fill) const {
        if (silent_) return;
        (void)caller_.call([&] {
            py::dict event;
            fill(event);
            function_(event);
        });
    }
    void progress(const std::string& label, int number, int count, const TestProgress& state) const {
        tell([&](py::dict& event) {
            event = progress_dict(state);
            event["label"] = label;
            event["number"] = number;
            event["count"] = count;
        });
    }
    void note(const std::string& line) const {
        tell([&](py::dict& event) {
            event["event"] = "note";
            event["text"] = line;
        });
    }
    void finished(const std::string& label, const TestResult& result) const {
        tell([&](py::dict& event) {
            event["event"] = "finished";
            event["label"] = label;
            event["text"] =
                fmt::format("{}: {:.4g} MPa, grade {}", label, result.properties.peak_stress_Pa * MPa, result.evidence.grade);
        });
    }

private:
    OnCaller& caller_;
    py::object function_;
    bool silent_;
};

PyResult shared(TestResult result) { return {std::make_shared<const TestResult>(std::move(result))}; }

PyResult run_one(const Job& job, const TestChoice& test, const py::object& sigma3, std::optional<std::uint64_t> seed,
                 const std::optional<std::string>& variant, int threads, const py::object& callback, long long every,
                 const std::optional<PyStage>& begins, const py::object& progress) {
    const Job one =
        single_run(job, test, sigma3.is_none() ? std::nullopt : std::optional(quantity_of(sigma3, Dimension::stress, "sigma3")),
                   seed, variant);
    const PlannedRun run = planned_runs(one).front();
    const int all_threads = threads_of(threads);
    if (every < 1) throw InputError({.key = "every"}, fmt::format("every {} steps", every), "1 or more");
    if (begins && callback.is_none())
        throw InputError({.key = "begins"}, "a first stage is given, and no callback that would go on from there",
                         "callback=..., or stages in the job");
    OnCaller caller;
    const Teller teller(caller, progress);
    std::unique_ptr<PyObserver> observer;
    if (!callback.is_none()) observer = std::make_unique<PyObserver>(caller, callback.cast<py::function>(), every, begins);
    std::atomic<bool> stop{false};
    std::optional<TestResult> result, failed;
    std::optional<std::string> problem;
    caller.run(
        [&] {
            const auto specimen = Packings(1, &stop).get(specimen_of(run), run.seed, all_threads);
            RunControl control;
            control.threads = Sharing(0, all_threads).useful_threads(body_count(run, *specimen));
            control.stop = &stop;
            control.observer = observer.get();
            if (!progress.is_none())
                control.progress = [&](const TestProgress& state) { teller.progress(label_of(run), 1, 1, state); };
            control.failed = [&](const TestResult& record) { failed = record; };
            try {
                result = run_test(setup_of(run, specimen), control);
                result->variant = run.variant->name;
            } catch (const NumericalError& error) {
                problem = error.what();
            }
        },
        [&] { stop = true; });
    if (caller.interrupted()) raise_interrupted(result ? py::cast(shared(std::move(*result))) : py::none());
    if (problem) raise_numerical(*problem, failed ? py::cast(shared(std::move(*failed))) : py::none());
    return shared(std::move(*result));
}

py::object job_result(const Job& job, std::vector<TestResult> results, const std::vector<FailedTest>& failed, bool interrupted,
                      const std::optional<std::string>& directory) {
    const PropertySummary summary = job.has_variants() ? PropertySummary{} : summarise(results);
    py::list list, failures;
    for (TestResult& result : results) list.append(shared(std::move(result)));
    for (const FailedTest& one : failed) {
        py::dict d;
        d["test"] = title(one.variant, one.test);
        d["seed"] = one.seed;
        d["reason"] = one.reason;
        failures.append(d);
    }
    return py::module_::import("feldspar.results")
        .attr("JobResult")(job.name, list, properties_of(summary), envelope_of(summary), failures, interrupted, directory);
}

// Takes the results of a job into memory.
class MemorySink final : public RunSink {
public:
    MemorySink(const std::vector<PlannedRun>& runs, std::atomic<bool>& stop, const Teller& teller)
        : runs_(runs), packings_(runs.size(), &stop), teller_(teller) {}

    int bodies(std::size_t i) override { return body_count(runs_[i], *specimen(i)); }
    RunningTests::Work begin(std::size_t i) override {
        return [this, i, made = specimen(i)](const RunControl& control) {
            TestResult result = run_test(setup_of(runs_[i], made), control);
            result.variant = runs_[i].variant->name;
            return result;
        };
    }
    void progress(std::size_t i, const TestProgress& state) override {
        teller_.progress(label_of(runs_[i]), static_cast<int>(i) + 1, static_cast<int>(runs_.size()), state);
    }
    void ended(std::size_t) override {}
    void finished(std::size_t i, TestResult result) override {
        if (!result.interrupted) teller_.finished(label_of(runs_[i]), result);
        if (!result.history.empty()) results_.emplace(i, std::move(result));
    }
    void failed(std::size_t i, const std::exception_ptr& error) override {
        try {
            std::rethrow_exception(error);
        } catch (const Interrupted&) {
            return;
        } catch (const std::exception& problem) {
            failed_.emplace(i, FailedTest{runs_[i].variant->name, *runs_[i].test, runs_[i].seed, problem.what()});
            teller_.note(fmt::format("{}: failed: {}", label_of(runs_[i]), problem.what()));
        }
    }
    std::vector<TestResult> take_results() {
        std::vector<TestResult> list;
        for (auto& [i, result] : results_) list.push_back(std::move(result));
        return list;
    }
    std::vector<FailedTest> failures() const {
        std::vector<FailedTest> list;
        for (const auto& [i, one] : failed_) list.push_back(one);
        return list;
    }

private:
    std::shared_ptr<const Specimen> specimen(std::size_t i) { return packings_.get(specimen_of(runs_[i]), runs_[i].seed, 1); }

    const std::vector<PlannedRun>& runs_;
    Packings packings_;
    const Teller& teller_;
    std::map<std::size_t, TestResult> results_;  // by number: the job's order
    std::map<std::size_t, FailedTest> failed_;
};

class Listener final : public JobListener {
public:
    explicit Listener(const Teller& teller) : teller_(teller) {}
    void busy(const std::string& what) override { teller_.note(what); }
    void making(const std::string&, const SpecimenProgress&) override {}
    void note(const std::string& line) override { teller_.note(line); }
    void progress(int number, int count, const std::string& label, const TestProgress& state) override {
        teller_.progress(label, number, count, state);
    }
    void ended(int) override {}
    void finished(const std::string& label, const TestResult& result) override { teller_.finished(label, result); }
    void clear() override {}
    void broken_off(std::size_t, const std::filesystem::path&) override {}

private:
    const Teller& teller_;
};

py::object run_whole(const Job& job, const std::vector<TestChoice>& tests, const std::vector<std::string>& variants,
                     const std::vector<std::uint64_t>& seeds, bool write, const std::optional<std::string>& directory, bool fresh,
                     int threads, int at_once, const py::object& progress) {
    const Job part = part_of(job, tests, variants, seeds);
    const int all_threads = threads_of(threads != 0 ? threads : part.threads);
    const int side_by_side = at_once != 0 ? at_once : part.at_once;
    if (side_by_side < 0)
        throw InputError({.key = "at_once"}, fmt::format("{} tests side by side", side_by_side),
                         "0 for as suits their size, or a number of tests");
    OnCaller caller;
    const Teller teller(caller, progress);
    std::atomic<bool> stop{false};
    const auto end = [&] { stop = true; };
    if (write) {
        Job writing = part;
        writing.at_once = side_by_side;
        Listener listener(teller);
        JobControl control;
        control.threads = all_threads;
        control.out = directory;
        control.fresh = fresh;
        control.provenance = collect_provenance("feldspar.run_job()", all_threads);
        control.stop = &stop;
        control.listener = &listener;
        std::optional<JobOutcome> outcome;
        caller.run([&] { outcome = run_job(writing, control); }, end);
        if (!outcome) raise_interrupted(py::none());
        const py::object result =
            job_result(writing, std::move(outcome->results), outcome->failed, outcome->interrupted, outcome->directory.string());
        if (caller.interrupted()) raise_interrupted(result);
        return result;
    }
    const std::vector<PlannedRun> runs = planned_runs(part);
    MemorySink sink(runs, stop, teller);
    caller.run([&] { (void)run_in_order(runs.size(), Sharing(side_by_side, all_threads), stop, sink); }, end);
    const py::object result = job_result(part, sink.take_results(), sink.failures(), caller.interrupted(), std::nullopt);
    if (caller.interrupted()) raise_interrupted(result);
    return result;
}

py::dict preview(const Job& job, const TestChoice& test, const py::object& sigma3, std::optional<std::uint64_t> seed,
                 const std::optional<std::string>& variant) {
    const Job one =
        single_run(job, test, sigma3.is_none() ? std::nullopt : std::optional(quantity_of(sigma3, Dimension::stress, "sigma3")),
                   seed, variant);
    const PlannedRun run = planned_runs(one).front();
    OnCaller caller;
    std::atomic<bool> stop{false};
    TestPreview p;
    caller.run(
        [&] {
            RunControl control;
            control.stop = &stop;
            p = preview_test(setup_of(run, Packings(1, &stop).get(specimen_of(run), run.seed, 1)), control);
        },
        [&] { stop = true; });
    if (caller.interrupted()) raise_interrupted(py::none());
    py::dict d;
    d["grains"] = p.grains;
    d["contacts"] = p.contacts;
    d["contact_points"] = p.contact_points;
    d["nodes"] = p.nodes;
    d["triangles"] = p.triangles;
    d["bodies"] = p.bodies;
    const auto range = [](const Foreseen& f, double factor) { return py::make_tuple(f.low * factor, f.high * factor); };
    d["memory_MB"] = p.memory_bytes.usual / 1e6;
    d["memory_range_MB"] = range(p.memory_bytes, 1e-6);
    d["expected_steps"] = p.steps.usual;
    d["steps_range"] = range(p.steps, 1.0);
    d["expected_seconds"] = p.steps.usual * p.step_seconds;
    d["seconds_range"] = range(p.steps, p.step_seconds);
    return d;
}

}  // namespace

void bind_running(py::module_& m) {
    m.def("run", &run_one, py::arg("job"), py::arg("test") = TestChoice{}, py::kw_only(), py::arg("sigma3") = py::none(),
          py::arg("seed") = py::none(), py::arg("variant") = py::none(), py::arg("threads") = 0, py::arg("callback") = py::none(),
          py::arg("every") = 1, py::arg("begins") = py::none(), py::arg("progress") = py::none(),
          R"(Runs one test on one packing in memory; feldspar.run() is the convenient form, which explains the arguments.)");
    m.def(
        "run_job", &run_whole, py::arg("job"), py::kw_only(), py::arg("tests") = std::vector<TestChoice>{},
        py::arg("variants") = std::vector<std::string>{}, py::arg("seeds") = std::vector<std::uint64_t>{},
        py::arg("write") = false, py::arg("directory") = py::none(), py::arg("fresh") = false, py::arg("threads") = 0,
        py::arg("at_once") = 0, py::arg("progress") = py::none(),
        R"(Runs all tests of a job on all its packings; feldspar.run_job() is the convenient form, which explains the arguments.)");
    m.def(
        "preview", &preview, py::arg("job"), py::arg("test") = TestChoice{}, py::kw_only(), py::arg("sigma3") = py::none(),
        py::arg("seed") = py::none(), py::arg("variant") = py::none(),
        R"(Builds and judges a test, and times a few steps, without running it: counts, memory_MB, expected_steps, expected_seconds, and the bounds of nine tests in ten: memory_range_MB, steps_range, seconds_range. Arguments as of run(). Raises InputError for a setting that is unstable.)");
}

}  // namespace feldspar::python
