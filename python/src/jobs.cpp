// Jobs: read, checked, listed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/base/usable_cores.hpp"
#include "feldspar/job/first_job.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/schema.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/study/packings.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

std::vector<std::string_view> views(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

bool is_called(const TestSpec& test, const std::string& word) {
    return word == name(test.kind) || word == test_name(test) || word == title(test);
}

template <class T>
void add_unless_there(std::vector<T>& list, const T& value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

void keep_tests(Job& job, const std::vector<TestChoice>& wanted) {
    std::set<std::size_t> kept;
    std::vector<std::string> known;
    for (const TestSpec& test : job.tests)
        for (const std::string& word : {std::string(name(test.kind)), test_name(test), title(test)})
            add_unless_there(known, word);
    for (const TestChoice& choice : wanted) {
        if (std::holds_alternative<std::monostate>(choice)) return;
        bool found = false;
        if (const auto* number = std::get_if<std::int64_t>(&choice)) {
            const auto count = static_cast<std::int64_t>(job.tests.size());
            const std::int64_t i = *number < 0 ? *number + count : *number;
            if (i < 0 || i >= count)
                throw InputError({.key = "test"}, fmt::format("the job has no test number {}", *number),
                                 fmt::format("0 ... {}", count - 1));
            kept.insert(static_cast<std::size_t>(i));
            continue;
        }
        const std::string& word = std::get<std::string>(choice);
        for (std::size_t i = 0; i < job.tests.size(); ++i)
            if (is_called(job.tests[i], word)) {
                kept.insert(i);
                found = true;
            }
        if (!found) {
            const auto words = views(known);
            throw InputError({.key = "test"}, fmt::format("the job has no test '{}'", word),
                             fmt::format("{}", fmt::join(known, ", ")), did_you_mean(word, words));
        }
    }
    if (wanted.empty()) return;
    std::vector<TestSpec> tests;
    for (const std::size_t i : kept) tests.push_back(job.tests[i]);
    job.tests = std::move(tests);
}

void keep_variants(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    if (!job.has_variants()) throw InputError({.key = "variant"}, "the job has no variants", "the job as it is, without variant");
    std::vector<std::string> known;
    for (const Variant& variant : job.variants) known.push_back(variant.name);
    const auto is = [](const Variant& variant, const std::string& word) { return variant.name == word || variant.stem == word; };
    for (const std::string& word : wanted)
        if (std::none_of(job.variants.begin(), job.variants.end(), [&](const Variant& variant) { return is(variant, word); })) {
            const auto words = views(known);
            throw InputError({.key = "variant"}, fmt::format("the job has no variant '{}'", word),
                             fmt::format("{}", fmt::join(known, "; ")), did_you_mean(word, words));
        }
    std::erase_if(job.variants, [&](const Variant& variant) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const std::string& word) { return is(variant, word); });
    });
}

void keep_seeds(Job& job, const std::vector<std::uint64_t>& seeds) {
    if (seeds.empty()) return;
    for (const std::uint64_t seed : seeds)
        if (std::count(seeds.begin(), seeds.end(), seed) > 1)
            throw InputError({.key = "seed"}, fmt::format("the seed {} is given twice", seed), "each seed once");
    if (!job.specimen.packing_file.empty() && seeds.size() > 1)
        throw InputError({.key = "seed"}, "several seeds are asked for, but the job loads one packing", "one seed");
    job.seeds = seeds;
    for (TestSpec& test : job.tests) test.seeds.clear();
    for (Variant& variant : job.variants) variant.seeds.clear();
}

py::dict test_dict(const TestSpec& test, std::size_t number) {
    py::dict d;
    d["number"] = number;
    d["kind"] = name(test.kind);
    d["name"] = test_name(test);
    d["title"] = title(test);
    d["purpose"] = method_of(test).purpose;
    d["sigma3_MPa"] = test.sigma3_Pa * MPa;
    d["stop_fraction"] = test.stop_fraction;
    d["control"] = test.control == LoadControl::gauge ? test.control_gauge : std::string(name(test.control));
    d["maximum_strain"] = test.maximum_strain;
    d["stages"] = stages_of(test).size();
    d["own_specimen"] = test.specimen.has_value();
    return d;
}

PySpecimen make_of(const Job& job, const TestChoice& test, std::optional<double> sigma3_Pa, std::optional<std::uint64_t> seed,
                   const std::optional<std::string>& variant, int threads) {
    const Job one = single_run(job, test, sigma3_Pa, seed, variant);
    const PlannedRun run = planned_runs(one).front();
    std::shared_ptr<const Specimen> made;
    OnCaller caller;
    std::atomic<bool> stop{false};
    caller.run([&] { made = Packings(1, &stop).get(specimen_of(run), run.seed, threads); }, [&] { stop = true; });
    if (caller.interrupted()) raise_interrupted(py::none());
    return with_phases(made, run.variant->grain, run.variant->contact, run.variant->rock);
}

}  // namespace

int threads_of(int wanted) {
    if (wanted < 0)
        throw InputError({.key = "threads"}, fmt::format("{} threads", wanted),
                         "0 for as many as there are cores, or a number of threads");
    return wanted == 0 ? usable_cores() : wanted;
}

double quantity_of(const py::object& given, Dimension dimension, const char* name) {
    if (py::isinstance<py::str>(given)) {
        try {
            return parse_quantity(given.cast<std::string>(), dimension);
        } catch (const InputError& error) {
            throw InputError({.key = name}, error.problem(), error.allowed(), error.suggestion());
        }
    }
    try {
        return given.cast<double>();
    } catch (const py::cast_error&) {
        throw InputError({.key = name}, "is neither a number in SI units nor text with a unit",
                         fmt::format("\"{}\", or the number in SI units", example(dimension)));
    }
}

Job part_of(const Job& job, const std::vector<TestChoice>& tests, const std::vector<std::string>& variants,
            const std::vector<std::uint64_t>& seeds, std::optional<double> sigma3_Pa) {
    Job part = job;
    keep_variants(part, variants);
    keep_tests(part, tests);
    if (sigma3_Pa) {
        std::vector<std::string> known;
        for (const TestSpec& test : part.tests) known.push_back(title(test));
        std::erase_if(part.tests, [&](const TestSpec& test) {
            return std::abs(test.sigma3_Pa - *sigma3_Pa) > 1e-9 * std::max(1.0, std::abs(*sigma3_Pa));
        });
        if (part.tests.empty())
            throw InputError({.key = "sigma3"}, fmt::format("the job has no such test at {:g} MPa", *sigma3_Pa * MPa),
                             fmt::format("{}", fmt::join(known, ", ")));
    }
    keep_seeds(part, seeds);
    if (planned_runs(part).empty())
        throw InputError({.key = "test"}, "nothing is left to run: the variant does not run this test, or not on this packing",
                         "another test, variant or seed");
    return part;
}

Job single_run(const Job& job, const TestChoice& test, std::optional<double> sigma3_Pa, std::optional<std::uint64_t> seed,
               const std::optional<std::string>& variant) {
    Job one = part_of(job, {test}, variant ? std::vector{*variant} : std::vector<std::string>{},
                      seed ? std::vector{*seed} : std::vector<std::uint64_t>{}, sigma3_Pa);
    const auto several = [](const char* key, const std::vector<std::string>& which) {
        throw InputError({.key = key}, fmt::format("a single test is run, and the job has {}", which.size()),
                         fmt::format("one of: {}", fmt::join(which, "; ")), "or run_job() for all of them");
    };
    if (one.tests.size() > 1) {
        std::vector<std::string> titles;
        for (const TestSpec& t : one.tests) titles.push_back(title(t));
        several("test", titles);
    }
    if (one.variants.size() > 1) {
        std::vector<std::string> names;
        for (const Variant& v : one.variants) names.push_back(v.name);
        several("variant", names);
    }
    if (!seed) keep_seeds(one, {planned_runs(one).front().seed});
    return one;
}

void bind_jobs(py::module_& m) {
    py::class_<Job, std::shared_ptr<Job>>(
        m, "Job", R"(A job: what is tested, on which specimens, of which material. Read and checked; it does not change.

Made by :meth:`read`, :meth:`parse` or :func:`feldspar.job`.)")
        .def_static(
            "read",
            [](const std::string& file, const std::vector<std::string>& settings) {
                return std::make_shared<Job>(read_job(file, settings));
            },
            py::arg("file"), py::arg("settings") = std::vector<std::string>{},
            "Reads and checks a job file. settings: \"key=value\", as `--set` of the program, over what the file says. Raises "
            "InputError with all mistakes, each with file, line, key and what is allowed.")
        .def_static(
            "parse",
            [](const std::string& text, const std::string& name, const std::vector<std::string>& settings) {
                return std::make_shared<Job>(parse_job(text, name, settings));
            },
            py::arg("text"), py::arg("name") = "<text>", py::arg("settings") = std::vector<std::string>{},
            "Reads and checks a job that is given as TOML text. `name` stands for the file in messages, and relative paths in "
            "the job count from its folder. settings: as of :meth:`read`.")
        .def_property_readonly(
            "name", [](const Job& job) { return job.name; }, "Name of the job: its key `name`, else from the file.")
        .def_property_readonly(
            "file", [](const Job& job) { return job.file.string(); }, "The file as it was given, or the name that stands for it.")
        .def_property_readonly(
            "text", [](const Job& job) { return job.text; }, "The TOML text as it was read.")
        .def_property_readonly(
            "seeds", [](const Job& job) { return job.seeds; }, "Seeds of the packings.")
        .def_property_readonly(
            "variants",
            [](const Job& job) {
                std::vector<std::string> names;
                for (const Variant& variant : job.variants)
                    if (!variant.name.empty()) names.push_back(variant.name);
                return names;
            },
            "Names of the variants; empty if the job has none.")
        .def_property_readonly(
            "laboratory", [](const Job& job) { return job.laboratory; },
            "What a laboratory measured: name to value in SI units, angles in radians.")
        .def_property_readonly(
            "tests",
            [](const Job& job) {
                py::list list;
                for (std::size_t i = 0; i < job.tests.size(); ++i) list.append(test_dict(job.tests[i], i));
                return list;
            },
            R"(The tests of the job in its order, a dictionary each: number, kind, name, title ("biaxial at 4 MPa"), purpose, sigma3_MPa (pressure; MPa), stop_fraction, control,
maximum_strain (a pure number), stages (how many), own_specimen (whether the test brings one).)")
        .def_property_readonly(
            "runs",
            [](const Job& job) {
                py::list list;
                for (const PlannedRun& run : planned_runs(job)) {
                    py::dict d;
                    d["label"] = label_of(run);
                    d["test"] = run.test - job.tests.data();
                    d["variant"] = run.variant->name;
                    d["seed"] = run.seed;
                    list.append(d);
                }
                return list;
            },
            "What the job stands for, in the order of its runs: dictionaries with label, test (its number), variant and seed.")
        .def(
            "warnings", [](const Job& job) { return warnings(job); },
            "Sentences on what is allowed but may not be what was meant; empty if there is nothing to say.")
        .def(
            "resolved", [](const Job& job) { return resolved_toml(job); },
            "The job with every default written out, as TOML text.")
        .def(
            "part",
            [](const Job& job, const std::vector<TestChoice>& tests, const std::vector<std::string>& variants,
               const std::vector<std::uint64_t>& seeds) { return std::make_shared<Job>(part_of(job, tests, variants, seeds)); },
            py::arg("tests") = std::vector<TestChoice>{}, py::arg("variants") = std::vector<std::string>{},
            py::arg("seeds") = std::vector<std::uint64_t>{},
            "The same job with only these tests (kinds, names, titles or numbers), variants and seeds; an empty list leaves all.")
        .def(
            "specimen",
            [](const Job& job, const TestChoice& test, const py::object& sigma3, std::optional<std::uint64_t> seed,
               const std::optional<std::string>& variant, int threads) {
                return make_of(job, test,
                               sigma3.is_none() ? std::nullopt : std::optional(quantity_of(sigma3, Dimension::stress, "sigma3")),
                               seed, variant, threads_of(threads));
            },
            py::arg("test") = TestChoice{}, py::kw_only(), py::arg("sigma3") = py::none(), py::arg("seed") = py::none(),
            py::arg("variant") = py::none(), py::arg("threads") = 0,
            R"(Makes the specimen of a test. Deterministic: the same job and seed give the same bits, for any number of threads.

test: kind, name, title or number; not needed if the job has one test. sigma3: of a test at several pressures, Pa or text with a unit. seed: of the packing; default the first of the job.
variant: not needed without variants. threads: 0 for as many as there are cores. Raises InputError, NumericalError.)")
        .def("__repr__", [](const Job& job) {
            return fmt::format("<feldspar.Job '{}': {} tests, {} runs>", job.name, job.tests.size(), planned_runs(job).size());
        });

    m.def(
        "job_template", [](const std::string& kind) { return job_template(kind); }, py::arg("kind"),
        "A commented job of this kind of test, or of a whole \"laboratory\", as TOML text. Raises InputError for an unknown "
        "kind.");
    m.def(
        "template_kinds",
        [] {
            std::vector<std::string> kinds;
            for (const std::string_view kind : job_template_kinds()) kinds.emplace_back(kind);
            return kinds;
        },
        "The kinds that job_template() knows.");
    m.def(
        "first_job",
        [](const std::string& kind, const std::map<std::string, std::string>& values, const std::string& rock) {
            FirstJob first = first_job(kind, GivenRock{rock, values});
            return py::make_tuple(first.text, first.warnings);
        },
        py::arg("kind"), py::arg("values"), py::arg("rock") = "",
        R"(A commented job with first contact parameters for a rock of which the laboratory's numbers are known. values: such as {"UCS": "120 MPa", "E": "30 GPa"}; rock: a rock of the literature,
or a kind of rock. Returns the TOML text and a list of warnings. Raises InputError.)");
    m.def("job_schema", &job_schema, "The keys of a job as the text of a JSON Schema.");
    m.def(
        "methods",
        [] {
            py::dict all;
            for (const MethodId id : test_methods()) all[py::str(name(id))] = method_of(id).purpose;
            return all;
        },
        "The test methods: name to purpose, in the order in which users are told.");
    m.def(
        "parse_quantity",
        [](const std::string& text, const std::string& dimension) {
            constexpr std::pair<std::string_view, Dimension> known[]{{"length", Dimension::length},
                                                                     {"stress", Dimension::stress},
                                                                     {"density", Dimension::density},
                                                                     {"stiffness_gradient", Dimension::stiffness_gradient},
                                                                     {"fracture_energy", Dimension::fracture_energy},
                                                                     {"speed", Dimension::speed},
                                                                     {"time", Dimension::time},
                                                                     {"angle", Dimension::angle},
                                                                     {"force", Dimension::force},
                                                                     {"energy", Dimension::energy},
                                                                     {"acceleration", Dimension::acceleration},
                                                                     {"toughness", Dimension::toughness},
                                                                     {"fraction", Dimension::fraction}};
            std::vector<std::string_view> names;
            for (const auto& [word, value] : known) {
                if (word == dimension) return quantity_of(py::str(text), value, "text");
                names.push_back(word);
            }
            throw InputError({.key = "dimension"}, fmt::format("'{}' is no dimension", dimension), listed(names),
                             did_you_mean(dimension, names));
        },
        py::arg("text"), py::arg("dimension"),
        R"(A number with its unit in SI (angles in radians), as jobs read it: parse_quantity("25.8 GPa", "stress") is 25.8e9. Raises InputError.)");
}

}  // namespace feldspar::python
