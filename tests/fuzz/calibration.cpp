// A calibration beside a job "rock.toml".
#include "feldspar/calibration/calibration.hpp"

#include "feldspar/job/job_template.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void calibration(std::string_view input) {
    static const std::filesystem::path rock = file_with("rock.toml", job_template("laboratory"));
    read_or_refuse(
        [&] { (void)contradictions(parse_calibration(std::string(input), rock.parent_path() / "calibration.toml").targets); });
}

}  // namespace feldspar::fuzz
