// The rows of the keys (job/keys.hpp), held against all that comes out of them: the reader, the schema, docs/job.md, templates.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/key_reference.hpp"
#include "feldspar/job/keys.hpp"
#include "feldspar/job/schema.hpp"
#include "json_schema.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path source = FELDSPAR_SOURCE_DIR;

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

Json json_of(const toml::table& table) {
    std::ostringstream text;
    text << toml::json_formatter(table);
    return Json::parse(text.str());
}
Json json_of(const std::string& toml) { return json_of(parse_toml(toml, "job")); }

std::string replaced(const std::string& text, const std::string& from, const std::string& to) { return edited(from, to, text); }

// Jobs that between them take every key.
const std::vector<std::string>& bases() {
    static const std::vector<std::string> all = [] {
        const std::string fixed = "kind = \"adaptive\"\naccuracy = \"0.5 %\"";
        std::string rigid = replaced(sample_job, "E = \"25.8 GPa\"\nnu = 0.23\n", "");
        rigid = replaced(rigid, "kind = \"flexible\"", "kind = \"rigid\"");
        std::string inner = replaced(replaced(rigid, "\"rigid\"", "\"inner-particles\""), "contact = \"lobatto3\"\n", "");
        inner = replaced(inner, "kind = \"uniaxial-compression\"", "kind = \"biaxial\"\nsigma3 = \"4 MPa\"");
        const std::string cut =
            "thickness = \"80 mm\"\nholes = [{ centre = [\"40 mm\", \"40 mm\"], diameter = \"10 mm\" }]\n"
            "notches = [{ from = [\"0 mm\", \"80 mm\"], to = [\"20 mm\", \"80 mm\"], width = \"1 mm\" }]\n"
            "labels = [{ name = \"load\", at = [\"40 mm\", \"160 mm\"], within = \"5 mm\" }]\n";
        const std::string own =
            replaced(replaced(sample_job, "kind = \"uniaxial-compression\"\n", custom_test), "thickness = \"80 mm\"\n", cut);
        const std::size_t first = own.find("[[test.fixture]]"), second = own.find("[[test.fixture]]", first + 1),
                          gauge = own.find("[[test.gauge]]");
        const std::string plates =
            own.substr(0, first) + own.substr(second, gauge - second) + own.substr(first, second - first) + own.substr(gauge);
        const std::string cells = replaced(
            replaced(sample_job, "shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"", "shape = \"from-file\""),
            "diameter = { distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\" }\nporosity = 0.10\n",
            "file = \"" + (source / "tests/unit/specimen/data/honeycomb.tess").string() + "\"\nunit = \"10 mm\"\n");
        return std::vector<std::string>{
            sample_job,
            cells,
            replaced(sample_job, "accuracy = \"0.5 %\"\n", ""),
            replaced(sample_job, fixed, "kind = \"paper\""),
            rigid,
            inner,
            replaced(sample_job, "kind = \"uniaxial-compression\"", "kind = \"brazilian\""),
            replaced(sample_job, "kind = \"uniaxial-compression\"", "kind = \"brazilian\"\nplates = \"flat\""),
            replaced(sample_job, "kind = \"uniaxial-compression\"", "kind = \"brazilian\"\ndisc = \"flattened\""),
            replaced(sample_job, "seeds = [1, 2, 3, 4, 5]\n", ""),
            own,
            plates,
            replaced(
                sample_job, "kind = \"uniaxial-compression\"",
                "kind = \"uniaxial-compression\"\nspecimen = { shape = \"rectangle\", width = \"40 mm\", height = \"80 mm\" }"),
            replaced(sample_job, "kind = \"uniaxial-compression\"\n", custom_test_in_stages),
            replaced(sample_job, "kind = \"uniaxial-compression\"\n", pressed_test),
            replaced(sample_job, "shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"",
                     "shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"], "
                     "[\"0 mm\", \"160 mm\"]]\nedge_labels = [\"bottom\", \"right\", \"top\", \"left\"]\n"
                     "arcs = [{ edge = 1, through = [\"60 mm\", \"80 mm\"] }]"),
            replaced(sample_job, "kind = \"uniaxial-compression\"", "kind = \"cyclic-compression\""),
            replaced(sample_job, "[numerics]", uneven_material),
            replaced(replaced(sample_job, "[numerics]", uneven_material),
                     "[[material.joint]]\nname = \"fault\"\ntrace = [[\"0 mm\", \"20 mm\"], [\"40 mm\", \"60 mm\"], [\"80 mm\", "
                     "\"70 mm\"]]\nmu = 0.5\nopening = \"1 um\"\n",
                     ""),
            replaced(replaced(replaced(sample_job, "[numerics]", uneven_material), "cluster_length = \"7 mm\"\n", ""),
                     "value = 7\n",
                     "value = 7\ndiameter = { distribution = \"uniform\", minimum = \"1 mm\", maximum = \"2 mm\" }\n"),
            replaced(replaced(sample_job, "[numerics]", uneven_material), "mu = 0.5\n",
                     "mu = 0.5\ndilation = \"9 deg\"\ndilation_slip = \"1 mm\"\n"),
            replaced(sample_job, "kind = \"uniaxial-compression\"",
                     "kind = \"multi-stage-biaxial\"\nsigma3 = [\"2 MPa\", \"5 MPa\"]"),
        };
    }();
    return all;
}

// The table of a path in a job; the first of a list.
toml::table* find_table(toml::table& job, std::string_view path) {
    toml::table* table = &job;
    std::istringstream parts{std::string(path)};
    for (std::string part; std::getline(parts, part, '.');) {
        toml::node* node = table->get(part);
        if (node != nullptr && node->is_array()) node = node->as_array()->get(0);
        if (node == nullptr || !node->is_table()) return nullptr;
        table = node->as_table();
    }
    return table;
}

TEST(Keys, DefaultsOfTheRowsAreThoseOfAJobThatSaysNothing) {
    std::size_t seen = 0;
    for (const KeyTable& table : job_tables())
        for (const JobKey& key : table.keys) {
            if (!key.usual.is_value()) continue;
            bool shown = false;
            for (const std::string& base : bases()) {
                toml::table without = parse_toml(base, "job");
                toml::table* place = find_table(without, table.path);
                if (place == nullptr) continue;
                place->erase(key.name);
                toml::table with = without;
                toml::table value = parse_toml("value = " + usual_text(key), "row");
                find_table(with, table.path)->insert_or_assign(key.name, *value.get("value"));
                try {
                    EXPECT_EQ(resolved_toml(read_tree(with, base, "job")), resolved_toml(read_tree(without, base, "job")))
                        << table.head << " " << key.name;
                    shown = true;
                } catch (const InputError&) {  // this job has no such key
                }
            }
            EXPECT_TRUE(shown) << table.head << " " << key.name << " = " << usual_text(key) << " is taken by none of the jobs";
            ++seen;
        }
    EXPECT_GT(seen, 25U);
}

TEST(Keys, AReaderTellsTheKeysOfItsRows) {
    const std::string variants = variant_job + "[laboratory]\n";
    for (const KeyTable& table : job_tables()) {
        toml::table job = parse_toml(variants, "job");
        for (const std::string& base : bases())
            if (find_table(job, table.path) == nullptr) job = parse_toml(base, "job");
        toml::table* place = find_table(job, table.path);
        ASSERT_NE(place, nullptr) << table.head;
        place->insert_or_assign("no_such_key", 1);
        try {
            (void)read_tree(job, "", "job");
            ADD_FAILURE() << table.head << " takes any key";
        } catch (const InputError& error) {
            bool told = false;
            for (const InputError& mistake : each_mistake(error))
                told = told || (mistake.problem() == "unknown key" && mistake.allowed() == listed(table.names()));
            EXPECT_TRUE(told) << table.head << ": " << error.what();
        }
    }
}

TEST(Keys, EachIsAsOftenAsItsNameInATableAndSaysWhatItIs) {
    for (const KeyTable& table : job_tables()) {
        std::set<std::string_view> names;
        for (const JobKey& key : table.keys) {
            EXPECT_TRUE(names.insert(key.name).second) << table.head << " " << key.name;
            EXPECT_FALSE(key.meaning.empty() || key.meaning.ends_with(".")) << table.head << " " << key.name;
            EXPECT_FALSE(usual_text(key).empty() || allowed(key).empty()) << table.head << " " << key.name;
            if (key.value.element.form == ValueForm::table) {
                EXPECT_NO_THROW((void)job_table(key.value.element.table)) << key.name;
            }
            if (!key.same_as.empty()) {
                EXPECT_NO_THROW((void)table.key(key.same_as)) << key.name;
            }
        }
    }
}

TEST(Keys, OfATestSayWhichMethodsTakeThem) {
    EXPECT_EQ(applies_text(job_key("test", "sigma3")),
              "with `kind = \"biaxial\", \"hole-compression\", \"multi-stage-biaxial\"`");
    EXPECT_EQ(applies_text(job_key("test", "flat_angle")), "with `kind = \"brazilian\"`");
    EXPECT_EQ(applies_text(job_key("test", "stop_fraction")), "");
    EXPECT_TRUE(job_key("test", "plate_mu").when.holds("biaxial"));
    EXPECT_FALSE(job_key("test", "plate_mu").when.holds("direct-tension"));
    EXPECT_EQ(applies_text(job_key("material.grain", "E")), "with `[model] kind = \"flexible\"`");
}

TEST(Keys, AreToldWithoutMarkup) {
    EXPECT_EQ(without_markup("of `[run] seeds` ([why](a.md)), see [laws](theory/b.md)"), "of [run] seeds, see laws");
    EXPECT_EQ(without_markup("plain, 2 (of 3)"), "plain, 2 (of 3)");
}

TEST(Schema, HasEveryKeyOfEveryTable) {
    const Json schema = Json::parse(job_schema());
    EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-04/schema#");
    for (const KeyTable& table : job_tables()) {
        const Json& object = table.path.empty() ? schema : schema["definitions"][std::string(table.path)];
        EXPECT_EQ(object["additionalProperties"], false) << table.head;
        EXPECT_EQ(object["properties"].size(), table.keys.size()) << table.head;
        for (const JobKey& key : table.keys) {
            ASSERT_TRUE(object["properties"].contains(key.name)) << table.head << " " << key.name;
            EXPECT_FALSE(object["properties"][std::string(key.name)].value("description", "").empty())
                << table.head << " " << key.name;
        }
    }
}

TEST(Schema, IsTheSameEveryTime) { EXPECT_EQ(job_schema(), job_schema()); }

TEST(Schema, TakesEveryJobOfTheExamplesAndStudiesAndTemplates) {
    const SchemaCheck schema(Json::parse(job_schema()));
    const auto expect_taken = [&](const std::string& name, const std::string& text) {
        for (const std::string& fault : schema.faults(json_of(text))) ADD_FAILURE() << name << ": " << fault;
    };
    std::size_t jobs = 0;
    for (const char* folder : {"examples", "studies", "tests/regression"})
        for (const auto& entry : fs::recursive_directory_iterator(source / folder)) {
            if (entry.path().extension() != ".toml") continue;
            const std::string text = text_of(entry.path());
            const toml::table tree = parse_toml(text, entry.path().string());
            if (!tree.contains("specimen") || tree.contains("job")) continue;
            ++jobs;
            expect_taken(entry.path().string(), text);
            expect_taken(entry.path().string() + ", resolved", resolved_toml(read_job(entry.path())));
        }
    EXPECT_GE(jobs, 10U) << "jobs are not found any more";
    for (const std::string_view kind : job_template_kinds()) expect_taken(std::string(kind), job_template(kind));
    for (const std::string& base : bases()) expect_taken("a job of this test", base);
    expect_taken("variants", variant_job);
}

TEST(Schema, RefusesWhatIsNoJob) {
    const SchemaCheck schema(Json::parse(job_schema()));
    const std::map<std::string, std::string> broken{
        {": unknown key numeric", replaced(sample_job, "[numerics]", "[numeric]")},
        {"specimen: unknown key widht", replaced(sample_job, "width =", "widht =")},
        {"specimen.width: is no string", replaced(sample_job, "\"80 mm\"\nheight", "80\nheight")},
        {"specimen.width: does not fit the pattern", replaced(sample_job, "\"80 mm\"\nheight", "\"80\"\nheight")},
        {"specimen.grains.porosity: is too large", replaced(sample_job, "porosity = 0.10", "porosity = 1.0")},
        {"specimen.grains.merge_length: fits none of several", replaced(sample_job, "\"auto\"", "1")},
        {"model.kind: is not one of the words", replaced(sample_job, "\"flexible\"", "\"flexibel\"")},
        {"material.grain.nu: is too large", replaced(sample_job, "nu = 0.23", "nu = 0.5")},
        {"test[1]: lacks kind", replaced(sample_job, "kind = \"uniaxial-compression\"", "snapshots = 3")},
        {"test[1].snapshots: is no integer",
         replaced(sample_job, "kind = \"uniaxial-compression\"", "kind = \"biaxial\"\nsnapshots = 0.5")},
        {"run.seeds[2]: is too small", replaced(sample_job, "[1, 2, 3, 4, 5]", "[1, -2]")},
        {"run.threads: fits none of several", replaced(sample_job, "seeds = [1, 2, 3, 4, 5]", "threads = 257")},
        {"laboratory.confined[1]: has too few", replaced(sample_job, "UCS = \"122.1 MPa\"", "confined = [[\"4 MPa\"]]")},
    };
    for (const auto& [fault, text] : broken) EXPECT_EQ(schema.faults(json_of(text)), std::vector<std::string>{fault});
}

// FELDSPAR_RECORD=1 writes the tables anew.
TEST(JobReference, HasTheTablesOfTheRows) {
    const fs::path file = source / "docs/job.md";
    const std::string text = text_of(file), wanted = with_key_reference(text);
    const char* record = std::getenv("FELDSPAR_RECORD");
    if (record != nullptr && *record != '\0' && std::string(record) != "0") {
        std::ofstream(file, std::ios::binary) << wanted;
    } else {
        EXPECT_TRUE(text == wanted)
            << "the tables of docs/job.md are not those of src/feldspar/job/keys.cpp. To write them anew:\n"
               "    FELDSPAR_RECORD=1 build/release/test_job --gtest_filter='JobReference.*'";
    }
    for (const KeyTable& table : job_tables())
        EXPECT_NE(wanted.find(key_reference(table)), std::string::npos)
            << "docs/job.md has no place for the keys of " << table.head;
}

TEST(JobReference, RefusesMarksWithoutATableOrAnEnd) {
    EXPECT_THROW((void)with_key_reference("<!-- keys of speciment -->\n<!-- end of keys -->"), InputError);
    EXPECT_THROW((void)with_key_reference("<!-- keys of specimen -->\n"), InputError);
    EXPECT_EQ(with_key_reference("a\n<!-- keys of model -->\nold\n<!-- end of keys -->\nb"),
              "a\n<!-- keys of model -->\n" + key_reference(job_table("model")) + "<!-- end of keys -->\nb");
}

// Lines such as "# snapshots = 8   # fields kept ...".
TEST(Template, ShowsTheDefaultsOfTheRows) {
    std::size_t seen = 0;
    std::istringstream lines(job_template("laboratory"));
    const KeyTable* table = nullptr;
    for (std::string line; std::getline(lines, line);) {
        for (const KeyTable& one : job_tables())
            if (line.starts_with(one.head)) table = &one;
        const std::size_t equals = line.find(" = ");
        if (table == nullptr || !line.starts_with("# ") || equals == std::string::npos) continue;
        const JobKey& key = table->key(line.substr(2, equals - 2));
        if (!key.usual.is_value() || key.value.shape != ValueShape::one) continue;
        EXPECT_EQ(line.substr(equals + 3, usual_text(key).size() + 1), usual_text(key) + " ") << line;
        ++seen;
    }
    EXPECT_GE(seen, 10U);
}

}  // namespace
}  // namespace feldspar
