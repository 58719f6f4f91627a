// Keys of a job that are set beside its file, and the user's units in a job that is written out.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/methods/method.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

Job with(const std::vector<std::string>& settings) { return parse_job(sample_job, "rock.toml", settings); }

// What a setting is refused with.
std::string refused(const std::string& setting) {
    try {
        (void)with({setting});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string with_tests(const std::string& tests) {
    std::string text = sample_job;
    const std::size_t at = text.find("[[test]]");
    return text.insert(at, tests);
}

TEST(SetKeys, LiesOverTheFile) {
    const Job job = with(
        {"material.contact.tau=31MPa", "material.contact.mu = 0.5", "run.seeds=[7, 8]", "model.plane=\"strain\"", "name=other"});
    EXPECT_EQ(job.variants.front().contact.tau_Pa, 31e6);
    EXPECT_EQ(job.variants.front().contact.mu, 0.5);
    EXPECT_EQ(job.seeds, (std::vector<std::uint64_t>{7, 8}));
    EXPECT_EQ(job.variants.front().model.plane, PlaneState::strain);
    EXPECT_EQ(job.name, "other");
}

TEST(SetKeys, TextNeedsNoQuotesAndALaterSettingGoesFirst) {
    EXPECT_EQ(with({"model.plane=strain"}).variants.front().model.plane, PlaneState::strain);
    EXPECT_EQ(with({"material.contact.tau=30 MPa", "material.contact.tau=32 MPa"}).variants.front().contact.tau_Pa, 32e6);
    EXPECT_EQ(with({"numerics.accuracy=0.5 %"}).variants.front().numerics.accuracy, 0.005);
}

TEST(SetKeys, InsideAnInlineTable) {
    EXPECT_EQ(with({"specimen.grains.diameter.minimum=1.5mm"}).specimen.grain_sizes.minimum_m, 0.0015);
}

TEST(SetKeys, OfAllTestsOrOfAKind) {
    const std::string text = with_tests("[[test]]\nkind = \"brazilian\"\n");
    const auto mu = [](const Job& job, MethodId kind) -> std::optional<double> {
        for (const TestSpec& test : job.tests)
            if (test.kind == kind) return test.plate_mu;
        return std::nullopt;
    };
    const std::vector<std::string> all{"test.plate_mu=0.25"}, one{"test.brazilian.plate_mu=0.15"},
        short_name{"test.BTS.plate_mu=0.15"};
    const Job of_all = parse_job(text, "rock.toml", all);
    EXPECT_EQ(mu(of_all, methods::brazilian), 0.25);
    EXPECT_EQ(mu(of_all, methods::uniaxial_compression), 0.25);
    for (const auto& settings : {one, short_name}) {
        const Job of_one = parse_job(text, "rock.toml", settings);
        EXPECT_EQ(mu(of_one, methods::brazilian), 0.15);
        EXPECT_NE(mu(of_one, methods::uniaxial_compression), 0.15);
    }
    EXPECT_NE(refused("test.DTS.plate_mu=0.2").find("the job has no test 'direct-tension'"), std::string::npos)
        << refused("test.DTS.plate_mu=0.2");
}

TEST(SetKeys, OfAVariantByItsName) {
    const std::string text = std::string(sample_job) + "\n[[variant]]\nname = \"soft\"\n[[variant]]\nname = \"hard rock\"\n";
    const std::vector<std::string> settings{"variant.\"hard rock\".material.contact.tau=50MPa"};
    const Job job = parse_job(text, "rock.toml", settings);
    EXPECT_NE(job.variants[0].contact.tau_Pa, 50e6);
    EXPECT_EQ(job.variants[1].contact.tau_Pa, 50e6);
}

// Each message names the setting, and says what the file's own reader would say.
TEST(SetKeys, WrongOnesAreRefusedByName) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
        {"material.contact.tau=30GJ", {"--set 'material.contact.tau=30GJ'", "a stress"}},
        {"material.contact.tua=30MPa", {"--set 'material.contact.tua=30MPa'", "unknown key", "did you mean 'tau'?"}},
        {"test.plate_mu=2.", {"--set 'test.plate_mu=2.'", "plain number"}},
        {"material.contact.mu=-1", {"--set 'material.contact.mu=-1'", "not allowed"}},
        {"meterial.contact.mu=1", {"--set 'meterial.contact.mu=1'", "did you mean 'material'?"}},
        {"model.plane=sideways", {"--set 'model.plane=sideways'", "stress, strain"}},
        {"material.contact.tau.high=1", {"'material.contact.tau' is not a table"}},
        {"material.contact.tau", {"has no '='"}},
        {"=5", {"has no key"}},
        {"name=", {"has no value"}},
        {"run.seeds=[1, 2", {"--set 'run.seeds=[1, 2'", "syntax error"}},
        {"a b=1", {"'a b' is not a key"}},
        {"br\xC3\xA9"
         "ite=1",
         {"is not a key"}},
        {"run.seeds=[1, \xC2\xB5]", {"syntax error"}},
        {"specimen.width=40 \xC2\xB5J", {"'40 \xC2\xB5J'"}},
        {"run.seeds=[1]\nname = \"x\"", {"run.seeds"}},
    };
    for (const auto& [setting, parts] : cases) {
        const std::string message = refused(setting);
        EXPECT_FALSE(message.empty()) << setting;
        for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << setting << " -> " << message;
        EXPECT_EQ(message.find("rock.toml:"), std::string::npos) << message;  // no line of the file is to blame
    }
}

TEST(SetKeys, AMistakeOfTheFileStillHasItsLine) {
    try {
        const std::vector<std::string> settings{"material.contact.mu=0.5"};
        (void)parse_job(std::string(sample_job) + "\n[model]\nplan = 1\n", "rock.toml", settings);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().file, "rock.toml");
        EXPECT_GT(error.place().line, 0);
    }
}

TEST(SetKeys, AreKeptBesideTheFilesText) {
    const Job job = with({"material.contact.mu=0.5"});
    EXPECT_EQ(job.text.rfind(sample_job, 0), 0u);
    EXPECT_NE(job.text.find("# --set material.contact.mu=0.5\n"), std::string::npos);
    EXPECT_EQ(with({}).text, sample_job);
}

TEST(GivenUnits, AreThoseOfTheUser) {
    const Job job = with({"material.contact.tau=31e3 kPa"});
    const std::string text = resolved_toml_in_given_units(job);
    EXPECT_NE(text.find("width = \"80 mm\""), std::string::npos) << text;
    EXPECT_NE(text.find("minimum = \"2 mm\""), std::string::npos) << text;
    EXPECT_NE(text.find("E = \"25.8 GPa\""), std::string::npos) << text;
    EXPECT_NE(text.find("tau = \"31e3 kPa\""), std::string::npos) << text;
    EXPECT_EQ(resolved_toml(parse_job(text, "again")),
              resolved_toml(parse_job(resolved_toml(job), "again")));  // the same to the last bit
}

TEST(GivenUnits, AreNotGuessed) {
    Job job = parse_job(sample_job, "rock.toml");
    job.specimen.outline.width_m = 0.0801;  // no longer what was written
    EXPECT_NE(resolved_toml_in_given_units(job).find("width = \"0.0801 m\""), std::string::npos);
}

TEST(Names, KeepTheirLetters) {
    EXPECT_EQ(parse_job(sample_job, "Größe 3.toml").name, "Größe-3");
    EXPECT_EQ(parse_job(sample_job, "花岗岩.toml").name, "花岗岩");
    EXPECT_EQ(parse_job(sample_job, "a\xff\x62.toml").name, "a-b");  // no UTF-8
    EXPECT_EQ(parse_job("name = \"Žula-2\"\n" + std::string(sample_job), "x.toml").name, "Žula-2");
    EXPECT_THROW(parse_job("name = \"a/b\"\n" + std::string(sample_job), "x.toml"), InputError);
    EXPECT_EQ(variant_stem("Glimmer, höher"), "glimmer-höher");
}

TEST(ShortNames, OfTheMethods) {
    EXPECT_EQ(find_method_called("UCS"), methods::uniaxial_compression);
    EXPECT_EQ(find_method_called("bts"), methods::brazilian);
    EXPECT_EQ(find_method_called("DTS"), methods::direct_tension);
    EXPECT_EQ(find_method_called("brazilian"), methods::brazilian);
    EXPECT_FALSE(find_method_called("").has_value());
    EXPECT_FALSE(find_method_called("XTS").has_value());
}

}  // namespace
}  // namespace feldspar
