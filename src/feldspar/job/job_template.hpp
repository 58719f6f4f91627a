// Jobs to start from, every line commented: what `feldspar new KIND` prints.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace feldspar {

/// The kinds that job_template() knows: the tests by their names, and "laboratory", which has all of them.
std::vector<std::string_view> job_template_kinds();

/// A complete commented job, which read_job() accepts as it stands. @throws InputError for an unknown kind.
std::string job_template(std::string_view kind);

}  // namespace feldspar
