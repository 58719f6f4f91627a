#include "feldspar/job/job.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "feldspar/base/utf8.hpp"
#include "feldspar/job/file_reader.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/set_keys.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr std::string_view kFurtherSigns = "-_.";  // of a file's name, beside letters and digits

// A name for the run's directory: letters, digits, '-', '_' and '.', not beginning with '.'.
std::string name_from_stem(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    std::string name;
    for (std::size_t i = 0; i < stem.size();) {
        const std::size_t length = std::max<std::size_t>(1, character_length(stem, i));
        const std::string_view character = std::string_view(stem).substr(i, length);
        if (name.size() + length > 100) break;
        name += made_of_letters_and(character, kFurtherSigns) ? character : "-";
        i += length;
    }
    name.erase(0, std::min(name.find_first_not_of('.'), name.size()));
    return name.empty() ? "job" : name;
}

std::string read_name(const JobTable& root, const std::filesystem::path& file) {
    if (!root.has("name")) return name_from_stem(file);
    std::string given = root.text("name");
    root.check({"name"}, [&] {
        if (given.front() == '.' || given.size() > 100 || !made_of_letters_and(given, kFurtherSigns))
            root.fail("name", shown(*root.find("name")) + " cannot name a directory", root.allowed("name"));
    });
    return given;
}

// A packing that is loaded has no other seeds.
void check_one_packing(const JobTable& root, const Job& job) {
    if (!root.sound({"run", "test", "specimen.packing"})) return;
    if (job.specimen.packing_file.empty()) return;
    bool several = job.seeds.size() > 1;
    for (const TestSpec& test : job.tests)
        several = several || test.seeds.size() > 1 || (test.seeds.size() == 1 && test.seeds.front() != job.seeds.front());
    if (!several) return;
    root.check({}, [&] {
        root.table("specimen").fail("packing", "is one packing, but several seeds are asked for", "one seed beside a packing");
    });
}

// The parts of a job in the order in which one asks for another.
class JobReader : private FileReader {
public:
    JobReader(toml::table tree, const std::string& text, const std::string& name)
        : FileReader(std::move(tree), name, job_table("").names(), {}, job_level) {
        job_.file = name;
        job_.text = text;
        job_.written = texts_of(tree_);
    }

    Job read() {
        const JobTable root(root_, job_table(""));
        job_.name = read_name(root, job_.file);
        (void)root.integer("format");  // only that it is one that we read
        if (root.has("variant"))
            root.require({"specimen", "test"});
        else
            root.require({"specimen", "material", "test"});

        const RunSettings run = read_run(root);
        job_.seeds = run.seeds;
        job_.threads = run.threads;
        job_.at_once = run.at_once;
        job_.variants = read_variants(root);
        std::optional<bool> filled;
        if (kinds_known(root, job_.variants))
            filled = std::any_of(job_.variants.begin(), job_.variants.end(),
                                 [](const Variant& v) { return v.model.kind == GrainKind::inner_particles; });
        job_.specimen = read_specimen(root, job_.file.parent_path(), filled, minerals_with_sizes(root, job_.variants));
        job_.tests = read_tests(root, job_.specimen, job_.variants, job_.seeds);
        check_variants(root, job_);
        job_.laboratory = read_laboratory(root);
        job_.laboratory_confined = read_laboratory_confined(root);

        check_one_packing(root, job_);
        finish();
        return std::move(job_);
    }

    SpecimenSpec read_specimen_alone() {
        const JobTable root(root_, job_table(""));
        root.require({"specimen"});
        const bool filled = static_cast<bool>(tree_["specimen"]["grains"]["particles_per_grain"]);
        SpecimenSpec specimen;
        if (root.has("specimen")) specimen = read_specimen(root, job_.file.parent_path(), filled, {});
        finish();
        return specimen;
    }

private:
    Job job_;
};

}  // namespace

SpecimenSpec disc_of(const SpecimenSpec& specimen, double diameter_m, double flat_angle_rad) {
    SpecimenSpec disc = specimen;
    if (specimen.outline.shape != Shape::disc || specimen.outline.diameter_m != diameter_m) disc.packing_file.clear();
    if (specimen.outline.shape != Shape::disc || specimen.outline.diameter_m != diameter_m || flat_angle_rad != 0.0 ||
        specimen.given_cells.cut)
        disc.given_cells.cut = true;
    disc.outline = OutlineSpec{};
    disc.outline.shape = Shape::disc;
    disc.outline.diameter_m = diameter_m;
    disc.outline.flat_angle_rad = flat_angle_rad;
    return disc;
}

Job read_tree(toml::table tree, const std::string& text, const std::string& name) {
    return JobReader(std::move(tree), text, name).read();
}

SpecimenSpec parse_specimen(const std::string& text, const std::string& name) {
    return JobReader(parse_toml(text, name), text, name).read_specimen_alone();
}

Job parse_job(const std::string& text, const std::string& name, std::span<const std::string> settings) {
    toml::table tree = parse_toml(text, name);
    set_keys(tree, settings);
    return read_tree(std::move(tree), with_settings(text, settings), name);
}

Job read_job(const std::filesystem::path& file, std::span<const std::string> settings) {
    return parse_job(read_toml_file(file, "job", "'feldspar new uniaxial-compression' prints a job to start from"), file.string(),
                     settings);
}

}  // namespace feldspar
