#include "feldspar/study/study.hpp"

namespace feldspar {

std::string study_template() {
    return R"(# A study: one job, varied along axes, on several packings. Every combination of the axes' values is a point (docs/study.md).
#
#   feldspar study STUDY.toml           runs what is not done yet; then the table of points. It may be interrupted: the same command goes on
#   feldspar study status STUDY.toml    how far it is
#
# The values are those of a granite (Monteiro Azevedo, Farinha, Oliveira 2022, Geotechnics 2, 523-548): replace them with yours.
# A line that begins with '#' shows a key that may be left out.

job = "rock.toml"                   # specimen, material, tests; to start from: feldspar new laboratory --out rock.toml
seeds = [1, 2, 3]                   # one packing each: the scatter between packings is part of the answer
tests = ["uniaxial-compression"]    # of those that the job has; all unless given
# keep = "histories"                # of each run: also "numbers", and "all", which is what feldspar run leaves

# [set]                             # a piece of a job that goes for all points
# numerics.accuracy = "1 %"         # looser is faster

[[axis]]
name = "mu"
key = "material.contact.mu"         # any key of a job; of all tests: test.KEY
values = [0.2, 0.4, 0.6]

[[axis]]
name = "tau/sigma_nt"
key = "material.contact.tau"
times = "material.contact.sigma_nt"     # the values are multiples of what this key has
values = [2, 3.5]

# [[axis]]
# name = "Gfn"
# key = "material.contact.Gfn"
# values = ["20 N/m", "40 N/m"]
# coupled = { material.contact.Gfs = 40 }   # goes with it: so many times its value

# [[axis]]                          # values that are pieces of a job, each with a name
# name = "law"
# [[axis.value]]
# label = "two lines"
# set = { material.contact.law = "bilinear" }
# [[axis.value]]
# label = "one line"
# set = { material.contact.law = "linear" }
)";
}

}  // namespace feldspar
