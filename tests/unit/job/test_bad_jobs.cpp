// A table of mistakes: what is written, where the message points, and what it must say.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/mistakes.hpp"
#include "sample_job.hpp"

namespace feldspar {
namespace {

struct BadJob {
    const char* what;
    std::string text;
    int line;                        // 0: the message has no place in the file
    std::vector<std::string> parts;  // of the whole message
    std::size_t mistakes = 1;        // told together
};

std::string with_test(const std::string& keys) { return edited("kind = \"uniaxial-compression\"", keys); }
std::string with_sizes(const std::string& keys) {
    return edited("distribution = \"uniform\", minimum = \"2 mm\", maximum = \"4 mm\"", keys);
}
std::string with_numerics(const std::string& keys) { return edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"", keys); }
std::string with_outline(const std::string& keys) {
    return edited("shape = \"rectangle\"\nwidth = \"80 mm\"\nheight = \"160 mm\"", keys);
}

std::vector<BadJob> bad_jobs() {
    return {
        {"empty file", "", 0, {"missing keys: specimen, material, test"}},
        {"lone bracket", "[", 1, {"syntax error", "table header"}},
        {"syntax", edited("width = \"80 mm\"", "width = 80 mm"), 3, {"syntax error"}},
        {"key twice", edited("width = \"80 mm\"", "width = \"80 mm\"\nwidth = \"90 mm\""), 4, {"syntax error", "width"}},
        {"not UTF-8", edited("shape", "sh\xff\xff"), 2, {"syntax error"}},
        {"unknown table",
         edited("[numerics]", "[numeric]"),
         28,
         {"numeric: unknown key", "did you mean 'numerics'?", "specimen"}},
        {"unknown key",
         edited("width", "widht"),
         3,
         {"job.toml:3:1", "specimen.widht: unknown key", "did you mean 'width'?", "allowed: shape, width"}},
        {"unknown nested key", edited("maximum", "maximun"), 7, {"specimen.grains.diameter.maximun", "did you mean 'maximum'?"}},
        {"key in another case", edited("Kn =", "kn ="), 21, {"material.contact.kn", "did you mean 'Kn'?"}},
        {"far from any key", edited("mu = 0.40", "mu = 0.40\nfavourite_colour = 1"), 26, {"favourite_colour", "unknown key"}},
        {"table that is a number",
         "model = 3\n" +
             edited("[model]\nkind = \"flexible\"\ncontact = \"lobatto3\"\nnormal = \"centres\"\nplane = \"stress\"\n", ""),
         1,
         {"model", "not a table"}},
        {"missing keys", edited("E = \"25.8 GPa\"\nnu = 0.23\n", ""), 15, {"material.grain", "missing keys: E, nu"}},
        {"missing material",
         edited("[material.grain]\nE = \"25.8 GPa\"\nnu = 0.23\ndensity = \"2650 kg/m3\"\n", ""),
         15,
         {"material", "missing key: grain"}},
        {"missing width", edited("width = \"80 mm\"\n", ""), 1, {"missing key: width"}},
        {"missing distribution", with_sizes("minimum = \"2 mm\", maximum = \"4 mm\""), 7, {"missing key: distribution"}},
        {"no unit", edited("\"80 mm\"", "80"), 3, {"specimen.width", "80 has no unit", "\"80 mm\""}},
        {"no unit in text", edited("\"80 mm\"", "\"80\""), 3, {"'80' has no unit"}},
        {"no number", edited("\"80 mm\"", "\"wide\""), 3, {"'wide' does not begin with a number"}},
        {"wrong unit", edited("\"80 mm\"", "\"80 mn\""), 3, {"'80 mn'", "did you mean 'mN'?"}},
        {"unknown unit", edited("\"80 mm\"", "\"80 ells\""), 3, {"unknown unit 'ells'"}},
        {"wrong dimension",
         edited("\"25.8 GPa\"", "\"25.8 GPa/m\""),
         16,
         {"material.grain.E", "is a stiffness per area, not a stress"}},
        {"milli for mega",
         edited("\"8.5 MPa\"", "\"8.5 mPa\""),
         23,
         {"sigma_nt", "thousandth of a pascal", "did you mean 'MPa'?"}},
        {"infinite", edited("\"8.5 MPa\"", "\"inf MPa\""), 23, {"not a finite number"}},
        {"not a number", edited("mu = 0.40", "mu = nan"), 25, {"mu", "not a finite number"}},
        {"number as text", edited("mu = 0.40", "mu = \"0.40\""), 25, {"'0.40' is not a plain number"}},
        {"list for a quantity", edited("\"80 mm\"", "[\"80 mm\"]"), 3, {"a list is not a length"}},
        {"negative size", edited("\"80 mm\"", "\"-80 mm\""), 3, {"'-80 mm' is not allowed", "greater than zero"}},
        {"no height", edited("\"160 mm\"", "\"0 mm\""), 4, {"specimen.height", "greater than zero"}},
        {"zero thickness",
         edited("thickness = \"80 mm\"", "thickness = \"0 mm\""),
         5,
         {"specimen.thickness", "greater than zero"}},
        {"porosity 1.1", edited("0.10", "1.1"), 8, {"specimen.grains.porosity", "1.1 is not allowed", "less than 1"}},
        {"porosity 1", edited("0.10", "1"), 8, {"porosity", "less than 1"}},
        {"porosity negative", edited("0.10", "-0.1"), 8, {"porosity"}},
        {"nu 0.5 in plane stress", edited("0.23", "0.5"), 17, {"material.grain.nu", "0.5 is not allowed", "less than 0.5"}},
        {"nu 0.5 in plane strain",
         edited("0.23", "0.5", edited("plane = \"stress\"", "plane = \"strain\"")),
         17,
         {"0.5 is not allowed", "plane strain"}},
        {"nu -1", edited("0.23", "-1.0"), 17, {"greater than -1"}},
        {"E zero", edited("\"25.8 GPa\"", "\"0 GPa\""), 16, {"material.grain.E", "greater than zero"}},
        {"density negative", edited("\"2650 kg/m3\"", "\"-1 kg/m3\""), 18, {"density"}},
        {"Kn zero", edited("\"18.00e4 GPa/m\"", "\"0 GPa/m\""), 21, {"Kn", "greater than zero"}},
        {"strength zero", edited("\"8.5 MPa\"", "\"0 MPa\""), 23, {"sigma_nt", "greater than zero"}},
        {"cohesion zero", edited("\"29.75 MPa\"", "\"0 MPa\""), 24, {"tau", "greater than zero"}},
        {"friction negative", edited("mu = 0.40", "mu = -0.4"), 25, {"mu", "zero or greater"}},
        {"fracture energy zero", edited("\"20 N/m\"", "\"0 N/m\""), 26, {"Gfn", "greater than zero"}},
        {"Gfn missing", edited("Gfn = \"20 N/m\"\n", ""), 19, {"material.contact", "missing key: Gfn"}},
        {"Gfn with brittle", edited("\"bilinear\"", "\"brittle\""), 26, {"Gfn", "does not apply to law = \"brittle\""}, 2},
        {"eta and kratio", edited("eta = 0.28", "eta = 0.28\nkratio = 3.6"), 23, {"kratio", "eta = ks/kn or kratio = kn/ks"}},
        {"neither eta nor kratio", edited("eta = 0.28\n", ""), 19, {"eta", "missing key", "kratio"}},
        {"unknown law", edited("\"bilinear\"", "\"bilinaer\""), 20, {"law", "'bilinaer'", "did you mean 'bilinear'?"}},
        {"grains larger than the specimen",
         with_sizes("distribution = \"uniform\", minimum = \"2 mm\", maximum = \"400 mm\""),
         7,
         {"specimen.grains.diameter", "do not fit", "80 mm"}},
        {"too many grains",
         with_sizes("distribution = \"uniform\", minimum = \"2 um\", maximum = \"4 um\""),
         7,
         {"grains", "at most 5000000"}},
        {"minimum above maximum",
         with_sizes("distribution = \"uniform\", minimum = \"5 mm\", maximum = \"4 mm\""),
         7,
         {"maximum", "less than the minimum"}},
        {"median outside",
         with_sizes("distribution = \"log-normal\", median = \"9 mm\", log_standard_deviation = 0.2, minimum = \"2 mm\", maximum "
                    "= \"4 mm\""),
         7,
         {"median", "between"}},
        {"median for uniform",
         with_sizes("distribution = \"uniform\", median = \"3 mm\", minimum = \"2 mm\", maximum = \"4 mm\""),
         7,
         {"median", "does not apply"}},
        {"sieve not increasing",
         with_sizes("distribution = \"sieve\", curve = [[\"2 mm\", 0], [\"4 mm\", 0.5], [\"3 mm\", 1]]"),
         7,
         {"curve", "'3 mm' is not larger than the sieve before it"}},
        {"passing not increasing",
         with_sizes("distribution = \"sieve\", curve = [[\"2 mm\", 0], [\"3 mm\", 0.5], [\"4 mm\", 0.4]]"),
         7,
         {"curve", "0.4 is less than passes the sieve before it"}},
        {"sieve incomplete",
         with_sizes("distribution = \"sieve\", curve = [[\"2 mm\", 0], [\"3 mm\", 0.5]]"),
         7,
         {"everything must pass the last sieve"}},
        {"sieve of one point", with_sizes("distribution = \"sieve\", curve = [[\"2 mm\", 0]]"), 7, {"at least two points"}},
        {"merge length in words", edited("\"auto\"", "\"automatic\""), 9, {"merge_length", "'automatic'", "\"auto\""}},
        {"merge length too long", edited("\"auto\"", "\"2 mm\""), 9, {"merge_length", "half a grain"}},
        {"no packing there",
         edited("thickness = \"80 mm\"", "packing = \"none-such.txt\""),
         5,
         {"specimen.packing", "there is no file"}},
        {"outline crosses itself",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"], [\"80 mm\", \"0 mm\"], "
                      "[\"0 mm\", \"160 mm\"]]"),
         3,
         {"specimen.vertices", "crosses or touches itself"}},
        {"two vertices",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"]]"),
         3,
         {"at least three vertices"}},
        {"labels do not match",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 "
                      "mm\"]]\nedge_labels = [\"bottom\", \"top\"]"),
         4,
         {"2 labels for 3 edges"}},
        {"ends exchanged",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"], [\"0 mm\", \"160 mm\"]]\n"
                      "edge_labels = [\"top\", \"right\", \"bottom\", \"left\"]"),
         4,
         {"specimen.edge_labels", "\"top\" lies below \"bottom\"", "allowed: \"top\" on the upper end", "exchange the labels"}},
        {"ends at the sides",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"], [\"0 mm\", \"160 mm\"]]\n"
                      "edge_labels = [\"a\", \"top\", \"b\", \"bottom\"]"),
         4,
         {"specimen.edge_labels", "90 degrees from horizontal", "turn the outline"}},
        {"confined trapezoid",
         edited("kind = \"uniaxial-compression\"", "kind = \"biaxial\"\nsigma3 = \"5 MPa\"",
                with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"70 mm\", \"160 mm\"], [\"10 mm\", \"160 mm\"]]\n"
                             "edge_labels = [\"bottom\", \"right\", \"top\", \"left\"]")),
         32,
         {"test[1].kind", "60", "80 mm", "a rectangle"}},
        {"radius of a rectangle",
         edited("width = \"80 mm\"", "width = \"80 mm\"\ndiameter = \"80 mm\""),
         4,
         {"specimen.diameter", "does not apply to shape = \"rectangle\""}},
        {"compression of a disc",
         with_outline("shape = \"disc\"\ndiameter = \"80 mm\""),
         31,
         {"test[1].kind", "a disc", "\"rectangle\""}},
        {"polygon without platens",
         with_outline("shape = \"polygon\"\nvertices = [[\"0 mm\", \"0 mm\"], [\"80 mm\", \"0 mm\"], [\"80 mm\", \"160 mm\"]]"),
         31,
         {"\"top\" and \"bottom\""}},
        {"accuracy too fine",
         edited("\"0.5 %\"", "\"0.01 %\""),
         30,
         {"numerics.accuracy", "'0.01 %' is not allowed", "0.05 % to 10 %"}},
        {"accuracy forgotten percent", edited("\"0.5 %\"", "0.5"), 30, {"accuracy", "0.05 % to 10 %"}},
        {"speed under adaptive",
         with_numerics("kind = \"adaptive\"\nspeed = \"6.25e-9 m\""),
         30,
         {"numerics.speed", "finds its own speed"}},
        {"accuracy under paper",
         with_numerics("kind = \"paper\"\naccuracy = \"0.5 %\""),
         30,
         {"numerics.accuracy", "does not apply to kind = \"paper\""}},
        {"speed per second under paper",
         with_numerics("kind = \"paper\"\nspeed = \"0.1 m/s\""),
         30,
         {"is a speed, not a length per step"}},
        {"dynamic without speed", with_numerics("kind = \"dynamic\""), 28, {"missing key: speed"}},
        {"damping 1", with_numerics("kind = \"paper\"\ndamping = 1.0"), 30, {"numerics.damping", "less than 1"}},
        {"no steps", with_numerics("maximum_steps = 0"), 29, {"maximum_steps", "1 or greater"}},
        {"half a step", with_numerics("maximum_steps = 1.5"), 29, {"not a whole number"}},
        {"confirm as text", with_numerics("confirm = \"yes\""), 29, {"numerics.confirm", "true, false"}},
        {"residual and accuracy",
         with_numerics("accuracy = 0.005\nresidual_target = 0.005"),
         30,
         {"residual_target", "accuracy"}},
        {"no test", edited("[[test]]\nkind = \"uniaxial-compression\"\n", ""), 0, {"missing key: test"}},
        {"empty test list", "test = []\n" + edited("[[test]]\nkind = \"uniaxial-compression\"\n", ""), 1, {"the list is empty", "one [[test]] or more"}},
        {"test as one table", edited("[[test]]", "[test]"), 31, {"[[test]]"}},
        {"unknown test", with_test("kind = \"uniaxial\""), 32, {"test[1].kind", "'uniaxial'", "brazilian"}},
        {"biaxial without sigma3", with_test("kind = \"biaxial\""), 31, {"missing key: sigma3"}},
        {"sigma3 zero", with_test("kind = \"biaxial\"\nsigma3 = \"0 MPa\""), 33, {"sigma3", "uniaxial-compression"}},
        {"a largest stress that is there already", with_test("kind = \"biaxial\"\nsigma3 = \"4 MPa\"\nmaximum_stress = \"4 MPa\""), 34, {"maximum_stress", "above sigma3"}},
        {"sigma3 in a uniaxial test",
         with_test("kind = \"uniaxial-compression\"\nsigma3 = \"4 MPa\""),
         33,
         {"only with kind = \"biaxial\""}},
        {"the same test twice", with_test("kind = \"biaxial\"\nsigma3 = [\"4 MPa\", \"4.0 MPa\"]"), 33, {"asked for twice"}},
        {"plates in compression",
         with_test("kind = \"uniaxial-compression\"\nplate_mu = 0.1"),
         33,
         {"test[1].plate_mu", "of flexible grains", "only with kind = \"brazilian\", or with rigid grains"}},
        {"grains larger than the disc",
         with_test("kind = \"brazilian\"\ndiameter = \"5 mm\""),
         33,
         {"test[1].diameter", "do not fit a disc of 5 mm"}},
        {"two diameters",
         with_test("kind = \"brazilian\"\ndiameter = \"50 mm\"\nseeds = [1]\n[[test]]\nkind = \"brazilian\"\nseeds = [2]"),
         35,
         {"one diameter in a job"}},
        {"stop fraction 1",
         with_test("kind = \"uniaxial-compression\"\nstop_fraction = 1.0"),
         33,
         {"stop_fraction", "less than 1"}},
        {"seed twice", edited("[1, 2, 3, 4, 5]", "[1, 2, 1]"), 34, {"run.seeds", "the seed 1 is given twice"}},
        {"no seeds", edited("[1, 2, 3, 4, 5]", "[]"), 34, {"run.seeds", "the list is empty"}},
        {"negative seed", edited("[1, 2, 3, 4, 5]", "[-1]"), 34, {"-1 is not allowed"}},
        {"seed and seeds", edited("seeds = [1, 2, 3, 4, 5]", "seeds = [1]\nseed = 2"), 35, {"run.seed"}},
        {"no threads", edited("seeds = [1, 2, 3, 4, 5]", "threads = 0"), 34, {"run.threads", "1 to 256"}},
        {"threads in words", edited("seeds = [1, 2, 3, 4, 5]", "threads = \"many\""), 34, {"run.threads", "auto"}},
        {"no tests at once", edited("seeds = [1, 2, 3, 4, 5]", "at_once = 0"), 34, {"run.at_once", "1 to 256"}},
        {"tests at once in words", edited("seeds = [1, 2, 3, 4, 5]", "at_once = \"all\""), 34, {"run.at_once", "auto", "1 to 256"}},
        {"half a test at once", edited("seeds = [1, 2, 3, 4, 5]", "at_once = 1.5"), 34, {"run.at_once", "whole number"}},
        {"name with a slash", "name = \"a/b\"\n" + sample_job, 1, {"name", "cannot name a directory"}},
        {"laboratory in the wrong unit",
         edited("\"122.1 MPa\"", "\"122.1 mm\""),
         36,
         {"laboratory.UCS", "is a length, not a stress"}},
        {"angle without unit", edited("UCS = \"122.1 MPa\"", "phi = 53"), 36, {"53 has no unit", "deg"}},
        {"confined without sigma_1", edited("UCS = \"122.1 MPa\"", "confined = [[\"4 MPa\"]]"), 36, {"laboratory.confined", "pairs of sigma_3 and sigma_1"}},
        {"confined the wrong way round", edited("UCS = \"122.1 MPa\"", "confined = [[\"150 MPa\", \"4 MPa\"]]"), 36, {"laboratory.confined", "sigma_3 first"}},
        {"cohesion twice", edited("UCS = \"122.1 MPa\"", "c = \"2 MPa\"\ncohesion = \"2 MPa\""), 36, {"which is the same"}},
    };
}

// The sample with rigid grains or inner particles, which have no elastic constants.
std::string with_kind(const std::string& kind, std::string text = sample_job) {
    return edited("E = \"25.8 GPa\"\nnu = 0.23\n", "", edited("kind = \"flexible\"", "kind = \"" + kind + "\"", std::move(text)));
}
std::string point_contact(std::string text) { return edited("contact = \"lobatto3\"\n", "", std::move(text)); }
std::string with_material(const std::string& keys) {
    return edited("[material.grain]", "[material]\n" + keys + "\n[material.grain]");
}

std::vector<BadJob> bad_particle_jobs() {
    const std::string inner = point_contact(with_kind("inner-particles")), rigid = with_kind("rigid");
    const auto test_of = [](const std::string& text, const std::string& keys) {
        return edited("kind = \"uniaxial-compression\"", keys, text);
    };
    return {
        {"unknown kind",
         edited("\"flexible\"", "\"flexibel\""),
         11,
         {"model.kind", "did you mean 'flexible'?", "inner-particles"}},
        {"three points of inner particles",
         with_kind("inner-particles"),
         12,
         {"model.contact", "'lobatto3' does not apply to kind = \"inner-particles\"", "\"point\""}},
        {"edge normal of rigid grains",
         edited("\"centres\"", "\"edge\"", rigid),
         13,
         {"model.normal", "does not apply to kind = \"rigid\"", "inner-particles"}},
        {"edge normal of flexible grains", edited("\"centres\"", "\"edge\""), 13, {"kind = \"flexible\""}},
        {"plane strain of rigid grains", edited("\"stress\"", "\"strain\"", rigid), 14, {"model.plane", "no plane state"}},
        {"plane strain of inner particles",
         edited("\"stress\"", "\"strain\"", inner),
         13,
         {"model.plane", "kind = \"flexible\""}},
        {"E of rigid grains",
         edited("kind = \"flexible\"", "kind = \"rigid\""),
         16,
         {"material.grain.E", "no elastic constants", "Kn and eta"},
         2},
        {"nu of inner particles",
         edited("density", "nu = 0.2\ndensity", inner),
         15,
         {"material.grain.nu", "kind = \"inner-particles\""}},
        {"particles of rigid grains",
         edited("merge_length = \"auto\"", "particles_per_grain = 30", rigid),
         9,
         {"specimen.grains.particles_per_grain", "only with kind = \"inner-particles\""}},
        {"too few particles", edited("merge_length = \"auto\"", "particles_per_grain = 6.9", inner), 9, {"from 7 to 500"}},
        {"too many particles", edited("merge_length = \"auto\"", "particles_per_grain = 501", inner), 9, {"from 7 to 500"}},
        {"friction of glued plates",
         test_of(rigid, "kind = \"direct-tension\"\nplate_mu = 0.1"),
         31,
         {"test[1].plate_mu", "glued"}},
        {"two stiffnesses of plates",
         test_of(rigid, "kind = \"direct-tension\"\nplate_Kn = \"1e4 GPa/m\"\nplate_stiffness_factor = 0.1"),
         31,
         {"test[1].plate_Kn", "given beside plate_stiffness_factor"}},
        {"stiffness of plates without a unit",
         test_of(rigid, "kind = \"direct-tension\"\nplate_Kn = 1e4"),
         31,
         {"test[1].plate_Kn", "has no unit"}},
        {"flats outside the Brazilian test",
         with_test("kind = \"uniaxial-compression\"\ndisc = \"flattened\""),
         33,
         {"test[1].disc", "only with kind = \"brazilian\""}},
        {"a disc of no kind",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flatened\""),
         33,
         {"test[1].disc", "whole", "did you mean 'flattened'?"}},
        {"an angle of a whole disc",
         test_of(sample_job, "kind = \"brazilian\"\nflat_angle = \"20 deg\""),
         33,
         {"test[1].flat_angle", "a whole disc", "disc = \"flattened\""}},
        {"flats too narrow",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flattened\"\nflat_angle = \"5 deg\""),
         34,
         {"test[1].flat_angle", "from 10 to 40 degrees"}},
        {"flats too wide",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flattened\"\nflat_angle = \"41 deg\""),
         34,
         {"test[1].flat_angle", "from 10 to 40 degrees"}},
        {"an angle without a unit",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flattened\"\nflat_angle = 20"),
         34,
         {"test[1].flat_angle", "20 has no unit", "deg"}},
        {"flats under jaws",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flattened\"\nplates = \"curved\""),
         34,
         {"test[1].plates", "curved jaws do not fit", "disc = \"whole\""}},
        {"flats narrower than a grain",
         test_of(sample_job, "kind = \"brazilian\"\ndiameter = \"20 mm\"\ndisc = \"flattened\""),
         34,
         {"test[1].disc", "3.47 mm wide", "4 mm", "smaller grains"}},
        {"two discs in a job",
         test_of(sample_job, "kind = \"brazilian\"\nseeds = [1]\n[[test]]\nkind = \"brazilian\"\nseeds = [2]\ndisc = \"flattened\""),
         37,
         {"test[2].disc", "differ from those of an earlier Brazilian test"}},
        {"a radius of flat plates",
         test_of(sample_job, "kind = \"brazilian\"\nplates = \"flat\"\njaw_radius = 1.5"),
         34,
         {"test[1].jaw_radius", "given for flat plates", "curved"}},
        {"a radius of the plates of a flattened disc",
         test_of(sample_job, "kind = \"brazilian\"\ndisc = \"flattened\"\njaw_radius = 1.5"),
         34,
         {"test[1].jaw_radius", "given for flat plates", "whole disc"}},
        {"jaws as round as the disc",
         test_of(sample_job, "kind = \"brazilian\"\nplates = \"curved\"\njaw_radius = 1"),
         34,
         {"test[1].jaw_radius", "more than 1"}},
        {"jaws in a tension test",
         test_of(sample_job, "kind = \"direct-tension\"\nplates = \"curved\""),
         33,
         {"test[1].plates", "only with kind = \"brazilian\""}},
        {"lateral strain of a pulled specimen",
         test_of(sample_job, "kind = \"direct-tension\"\ncontrol = \"lateral-strain\""),
         33,
         {"test[1].control", "does not measure", "\"dissipation\""}},
        {"an unknown control",
         test_of(sample_job, "kind = \"uniaxial-compression\"\ncontrol = \"disipation\""),
         33,
         {"test[1].control", "did you mean 'dissipation'"}},
        {"a servo at a fixed speed",
         edited("kind = \"adaptive\"\naccuracy = \"0.5 %\"", "kind = \"paper\"", edited("kind = \"uniaxial-compression\"", "kind = \"uniaxial-compression\"\ncontrol = \"dissipation\"")),
         32,
         {"test[1].control", "only adaptive numerics", "control = \"displacement\""}},
        {"soft plates on flexible grains",
         test_of(sample_job, "kind = \"direct-tension\"\nplate_stiffness_factor = 0.1"),
         33,
         {"plate_stiffness_factor", "flexible grains"}},
        {"membrane without pressure",
         test_of(rigid, "kind = \"uniaxial-compression\"\nmembrane_plates = 16"),
         31,
         {"membrane_plates", "only with kind = \"biaxial\""}},
        {"membrane of flexible grains",
         test_of(sample_job, "kind = \"biaxial\"\nsigma3 = \"4 MPa\"\nmembrane_plates = 16"),
         34,
         {"membrane_plates", "flexible grains"}},
        {"no membrane plate",
         test_of(rigid, "kind = \"biaxial\"\nsigma3 = \"4 MPa\"\nmembrane_plates = 0"),
         32,
         {"membrane_plates", "1 to 1000"}},
        {"unknown elastic preset",
         with_material("elastic_preset = \"augig-flexibel\""),
         16,
         {"material.elastic_preset", "is not a preset", "did you mean 'augig-flexible'?", "augig-rigid"}},
        {"unknown strength preset",
         with_material("strength_preset = \"table7\""),
         16,
         {"material.strength_preset", "augig-table7"}},
        {"preset of other grains",
         with_material("elastic_preset = \"augig-rigid\""),
         16,
         {"'augig-rigid' is for kind = \"rigid\"", "kind = \"flexible\"", "augig-flexible, augig-flexible-51.6"}},
        {"brittle preset with a fracture energy",
         edited("law = \"bilinear\"\n", "", with_material("strength_preset = \"augig-table2-brittle\"")),
         27,
         {"Gfn", "does not apply to law = \"brittle\""},
         2},
        {"half a material",
         "[material]\nelastic_preset = \"augig-flexible\"\n" +
             edited("[material.contact]\nlaw = \"bilinear\"\nKn = \"18.00e4 GPa/m\"\neta = 0.28\nsigma_nt = \"8.5 MPa\"\ntau = "
                    "\"29.75 MPa\"\nmu = 0.40\nGfn = \"20 N/m\"\nGfs = \"800 N/m\"\n",
                    ""),
         2,
         {"material.contact", "missing keys: sigma_nt, tau, mu, Gfn, Gfs"}},
    };
}

std::vector<BadJob> bad_variant_jobs() {
    const auto with = [](const std::string& from, const std::string& to) { return edited(from, to, variant_job); };
    return {
        {"variant as one table", "variant = { name = \"a\" }\n" + sample_job, 1, {"variant", "[[variant]]"}},
        {"empty list of variants", "variant = []\n" + sample_job, 1, {"the list is empty"}},
        {"variant that is a word", "variant = [\"a\"]\n" + sample_job, 1, {"'a' is not a variant"}},
        {"variant without a name", with("name = \"Rigid, bilinear\"\n", ""), 12, {"variant[1]", "missing key: name"}},
        {"name that is none", with("\"Rigid, bilinear\"", "\", -\""), 13, {"variant[1].name", "cannot name a variant"}},
        {"name with a slash", with("\"Rigid, bilinear\"", "\"a/b\""), 13, {"cannot name a variant"}},
        {"name twice", with("\"flexible 25.8\"", "\"Rigid, bilinear\""), 17, {"variant[2].name", "is given twice"}},
        {"files twice",
         with("\"flexible 25.8\"", "\"rigid bilinear\""),
         17,
         {"variant[2].name", "share its files with 'Rigid, bilinear'"}},
        {"unknown key", with("seeds = [2]", "seed = [2]"), 18, {"variant[2].seed", "did you mean 'seeds'?"}},
        {"unknown key in a table", with("nu = 0.25", "mu = 0.25"), 25, {"variant[2].material.grain.mu", "did you mean 'nu'?"}},
        {"a test in a variant", with("seeds = [2]", "test = 1"), 18, {"variant[2].test", "unknown key"}},
        {"seed of another job", with("seeds = [2]", "seeds = [2, 7]"), 18, {"variant[2].seeds", "7 is not one of the run's"}},
        {"unknown kind of test", with("\"biaxial\"]", "\"biaxail\"]"), 19, {"variant[2].tests", "did you mean 'biaxial'?"}},
        {"kind that is not run", with("\"biaxial\"]", "\"brazilian\"]"), 19, {"no test of kind 'brazilian'"}},
        {"kind twice", with("\"biaxial\"]", "\"uniaxial-compression\"]"), 19, {"given twice"}},
        {"no kinds", with("tests = [\"uniaxial-compression\", \"biaxial\"]", "tests = []"), 19, {"the list is empty"}},
        {"nothing to run",
         edited("sigma3 = \"4 MPa\"", "sigma3 = \"4 MPa\"\nseeds = [1]",
                with("\"uniaxial-compression\", \"biaxial\"]", "\"biaxial\"]")),
         18,
         {"variant[2].seeds", "nothing is left to run"}},
        {"preset of the job for other grains",
         with("elastic_preset = \"augig-flexible\"\n", ""),
         8,
         {"material.elastic_preset", "'augig-rigid' is for kind = \"rigid\"", "augig-flexible"}},
        {"preset of the variant for other grains",
         with("\"augig-inner-particles\"", "\"augig-rigid\""),
         34,
         {"variant[3].material.elastic_preset", "augig-inner-particles"}},
        {"value in a variant", with("mu = 0.45", "mu = -1"), 37, {"variant[3].material.contact.mu", "zero or greater"}},
        {"fracture energy beside a brittle preset",
         with("mu = 0.45", "Gfn = \"20 N/m\""),
         37,
         {"variant[3].material.contact.Gfn"}},
        {"elastic constants of a rigid variant",
         with("[variant.model]\nkind = \"rigid\"", "[variant.model]\nkind = \"rigid\"\n[variant.material.grain]\nE = \"1 GPa\""),
         17,
         {"variant[1].material.grain.E", "no elastic constants"}},
        {"numerics of a variant",
         with("kind = \"paper\"", "kind = \"paper\"\naccuracy = \"1 %\""),
         28,
         {"variant[2].numerics.accuracy"}},
        {"no material at all",
         with("[material]\nelastic_preset = \"augig-rigid\"\nstrength_preset = \"augig-table2-bilinear\"\n", ""),
         9,
         {"variant[1]", "missing key: material"},
         2},   // the second variant, which has a preset for stiffnesses only, misses strengths
        {"plates that no variant has",
         edited("kind = \"direct-tension\"", "kind = \"brazilian\"\nmembrane_plates = 3", variant_job),
         42,
         {"test[2].membrane_plates", "biaxial"}},
    };
}

void expect_refused(const std::vector<BadJob>& jobs) {
    for (const BadJob& bad : jobs) {
        SCOPED_TRACE(bad.what);
        try {
            (void)parse_job(bad.text, "job.toml");
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(each_mistake(error).size(), bad.mistakes) << message;
            EXPECT_EQ(error.place().file, "job.toml");
            EXPECT_EQ(error.place().line, bad.line) << message;
            EXPECT_GE(error.place().column, bad.line > 0 ? 1 : 0) << message;
            for (const std::string& part : bad.parts)
                EXPECT_NE(message.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << message;
        }
    }
}

TEST(BadJob, IsRefusedAtItsPlaceWithItsReason) {
    expect_refused(bad_jobs());
    EXPECT_GE(bad_jobs().size(), 20u);
}

TEST(BadJob, OfRigidGrainsAndInnerParticles) { expect_refused(bad_particle_jobs()); }

TEST(BadJob, OfVariants) { expect_refused(bad_variant_jobs()); }

TEST(BadJob, FilesThatCannotBeRead) {
    for (const char* file : {"/none/such/job.toml", "/", ""}) {
        try {
            (void)read_job(file);
            ADD_FAILURE() << "accepted " << file;
        } catch (const InputError& error) {
            EXPECT_EQ(error.place().file, file);
        }
    }
}

}  // namespace
}  // namespace feldspar
