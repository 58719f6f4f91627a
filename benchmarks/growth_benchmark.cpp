// The program behind ./bench --growth: what each stage takes a grain, in processor time and memory, from small specimens to large
// ones. What grows faster than the specimen shows as a row that rises. docs/performance.md says how to read it.
#include <fmt/format.h>
#include <stdlib.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/growth.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/base/text_table.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/test_fields.hpp"

namespace feldspar::benchmarks {
namespace {

struct Options {
    std::vector<int> sizes{1000, 4000, 16000, 64000};
    int threads = 1;
    bool set_up_only = false;
    std::string folder;
};

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A line of what the system tells of this program, in bytes; 0 where it tells nothing.
double memory_of_status(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(name + ":")) return 1024.0 * std::stod(line.substr(name.size() + 1));
    return 0.0;
}

// Takes the present memory for the largest so far.
void forget_largest_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

// What was freed goes back to the system, so that it does not hide what the next stage takes.
void give_memory_back() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

struct Taken {
    double seconds = 0.0;  // of processor time
    double peak = 0.0;     // bytes of the program at the largest
};

// What the stages of one size take.
class Meter {
public:
    StageWatch watch() {
        return [this](std::string_view stage, const std::function<double()>& work) {
            give_memory_back();
            forget_largest_memory();
            const double start = processor_seconds(), times = work();
            Taken taken{(processor_seconds() - start) / std::max(1.0, times), memory_of_status("VmHWM")};
            order_.emplace_back(stage);
            stages_.emplace(stage, taken);
            fmt::print(stderr, "  {:<28} {:8.3f} s  {:7.0f} MB\n", stage, taken.seconds, 1e-6 * taken.peak);
        };
    }
    const std::vector<std::string>& order() const { return order_; }
    const Taken& of(const std::string& stage) const { return stages_.at(stage); }

private:
    std::vector<std::string> order_;
    std::map<std::string, Taken, std::less<>> stages_;
};

const char* const kJob = R"(name = "growth"
[specimen]
shape = "rectangle"
width = "80 mm"
height = "160 mm"
thickness = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
porosity = 0.10
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[[test]]
kind = "uniaxial-compression"
[run]
seeds = [1]
)";

// A folder that goes with its files.
class Folder {
public:
    explicit Folder(const std::filesystem::path& parent) : path_((parent / "feldspar-growth-XXXXXX").string()) {
        if (mkdtemp(path_.data()) == nullptr) throw OutputError(fmt::format("no folder can be made in '{}'", parent.string()));
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

void write_files(const TestResult& result, const std::filesystem::path& parent, const StageWatch& watch) {
    const Folder folder(parent);
    const RunDirectory directory = RunDirectory::open(folder.path());
    const Job job = parse_job(kJob, "growth.toml");
    const Provenance provenance = collect_provenance("", 1);
    const std::span<const TestResult> one(&result, 1);
    const auto stage = [&](const char* name, const std::function<void()>& work) {
        watch(name, [&] {
            work();
            return 1.0;
        });
    };
    stage("archive (HDF5)", [&] { write_hdf5(directory, result, job, provenance); });
    stage("files for ParaView", [&] { write_paraview(directory, fields_of(result)); });
    stage("tables, summary, report", [&] {
        write_history_csv(directory, result, provenance);
        write_events_csv(directory, result);
        const PropertySummary properties = summarise(one);
        write_summary(directory, job, one, properties, provenance, true);
        write_report(directory, job, one, properties, provenance, true);
    });
}

void print_table(const std::string& title, const std::vector<int>& grains, const std::vector<Meter>& meters,
                 const std::function<double(const Taken&, int)>& value) {
    Row head{title};
    for (const int count : grains) head.push_back(std::to_string(count));
    head.push_back("last/first");
    std::vector<Row> rows{head};
    for (const std::string& stage : meters.front().order()) {
        Row row{stage};
        std::vector<double> values;
        for (std::size_t i = 0; i < meters.size(); ++i) {
            values.push_back(value(meters[i].of(stage), grains[i]));
            row.push_back(table_number(values.back()));
        }
        row.push_back(fmt::format("{:.2f}", values.back() / values.front()));
        rows.push_back(row);
    }
    fmt::print("{}\n", aligned(rows, 1));
}

int report_on(const Options& options) {
    std::vector<int> grains;
    std::vector<Meter> meters;
    std::vector<double> counted;
    meters.reserve(options.sizes.size());
    give_memory_back();
    const double empty = memory_of_status("VmRSS");
    for (const int size : options.sizes) {
        fmt::print(stderr, "{} grains\n", size);
        Meter& meter = meters.emplace_back();
        GrowingTest test(size, options.threads, meter.watch());
        test.set_up(meter.watch());
        counted.push_back(test.specimen_bytes() + test.assembly_bytes());
        grains.push_back(test.grains());
        if (options.set_up_only) continue;
        test.test(meter.watch());
        write_files(test.result(), options.folder, meter.watch());
    }
    fmt::print("{} thread{}\n\n", options.threads, options.threads == 1 ? "" : "s");
    print_table("processor time, us a grain; grains:", grains, meters,
                [](const Taken& taken, int count) { return 1e6 * taken.seconds / count; });
    print_table("largest memory meanwhile, kB a grain:", grains, meters,
                [&](const Taken& taken, int count) { return 1e-3 * (taken.peak - empty) / count; });
    fmt::print("specimen and body in memory, kB a grain:");
    for (std::size_t i = 0; i < grains.size(); ++i) fmt::print(" {}", table_number(1e-3 * counted[i] / grains[i]));
    fmt::print("; the program itself {:.0f} MB\n", 1e-6 * empty);
    return 0;
}

}  // namespace
}  // namespace feldspar::benchmarks

int main(int argc, char** argv) {
    CLI::App app("Measures what each stage of a test takes a grain, at several sizes (docs/performance.md).");
    feldspar::benchmarks::Options options;
    options.folder = std::filesystem::temp_directory_path().string();
    app.add_option("--sizes", options.sizes, "numbers of grains, about")->check(CLI::Range(100, 10000000))->capture_default_str();
    app.add_option("--threads", options.threads, "threads of packing, cells, mesh and steps")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_flag("--set-up", options.set_up_only, "only what comes before the first step");
    app.add_option("--folder", options.folder, "where files are written, and removed again")
        ->type_name("DIR")
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        return feldspar::benchmarks::report_on(options);
    } catch (const feldspar::InputError& error) {
        fmt::print(stderr, "growth_benchmark: {}\n", error.what());
        return static_cast<int>(feldspar::ExitCode::input);
    } catch (const feldspar::OutputError& error) {
        fmt::print(stderr, "growth_benchmark: {}\n", error.what());
        return static_cast<int>(feldspar::ExitCode::output);
    }
}
