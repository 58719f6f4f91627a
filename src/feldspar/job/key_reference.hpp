// The keys of a job for people: the tables of docs/job.md.
#pragma once

#include <string>
#include <string_view>

#include "feldspar/job/keys.hpp"

namespace feldspar {

/// One table in Markdown: key, meaning, what is allowed, default.
std::string key_reference(const KeyTable& table);

/// All tables, each under its heading: what `feldspar schema --markdown` prints.
std::string key_reference();

/// A text in which what stands between "<!-- keys of PATH -->" and "<!-- end of keys -->" is written anew from the rows of the
/// table PATH ("file" for the file itself). @throws InputError if a mark names no table or has no end.
std::string with_key_reference(std::string_view text);

}  // namespace feldspar
