// Claims on a study "study.toml" that stands beside them.
#include "feldspar/findings/claims.hpp"

#include "../small_study.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void claims(std::string_view input) {
    static const std::filesystem::path job = file_with("job.toml", small_job);
    static const std::filesystem::path study = file_with(
        "study.toml",
        "job = \"job.toml\"\n[[axis]]\nname = \"grains\"\n[[axis.value]]\nlabel = \"flexible\"\n[[axis.value]]\nlabel = "
        "\"rigid\"\n"
        "set = { model.kind = \"rigid\" }\n[[axis]]\nname = \"mu\"\nkey = \"material.contact.mu\"\nvalues = [0.3, 0.6]\n");
    read_or_refuse([&] { (void)read_studies(parse_claims(std::string(input), job.parent_path() / "claims.toml")); });
}

}  // namespace feldspar::fuzz
