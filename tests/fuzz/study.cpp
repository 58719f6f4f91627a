// A study file beside a job "job.toml".
#include "feldspar/study/study.hpp"

#include "../small_study.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void study(std::string_view input) {
    static const std::filesystem::path job = file_with("job.toml", small_job);
    read_or_refuse([&] { (void)parse_study(std::string(input), job.parent_path() / "study.toml"); });
}

}  // namespace feldspar::fuzz
