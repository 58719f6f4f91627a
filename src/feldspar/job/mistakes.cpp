#include "feldspar/job/mistakes.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace feldspar {
namespace {

// "material" is inside "material", and so are "material.grain" and "material[1]"; "materials" is not.
bool is_inside(std::string_view key, std::string_view table) {
    return key.starts_with(table) && (key.size() == table.size() || key[table.size()] == '.' || key[table.size()] == '[');
}

}  // namespace

InputErrors::InputErrors(std::vector<InputError> all) : InputError(all.front()), all_(std::move(all)) {
    for (std::size_t i = 0; i < std::min(all_.size(), most_told); ++i) {
        if (i > 0) text_ += "\n";
        text_ += all_[i].what();
    }
    if (all_.size() > most_told)
        text_ += std::string("\nand ") + (all_.size() >= most_kept ? "at least " : "") + std::to_string(all_.size() - most_told) +
                 " more";
}

std::vector<InputError> each_mistake(const InputError& error) {
    if (const auto* several = dynamic_cast<const InputErrors*>(&error)) return several->all();
    return {error};
}

void Mistakes::add(const InputError& error, const std::string& spoils) {
    if (!spoils.empty()) spoil(spoils);
    for (const InputError& one : each_mistake(error)) {
        const bool known = std::any_of(found_.begin(), found_.end(),
                                       [&](const InputError& other) { return std::string_view(other.what()) == one.what(); });
        if (!known) found_.push_back(one);
    }
    if (found_.size() >= InputErrors::most_kept) throw_if_any();
}

bool Mistakes::sound(std::string_view key) const {
    return std::none_of(spoilt_.begin(), spoilt_.end(),
                        [&](const std::string& spoilt) { return is_inside(key, spoilt) || is_inside(spoilt, key); });
}

void Mistakes::throw_if_any() const {
    if (found_.empty()) return;
    if (found_.size() == 1) throw found_.front();
    std::vector<std::string> files{file_};  // and then as they came
    const auto rank = [&](const InputError& error) {
        return std::find(files.begin(), files.end(), error.place().file) - files.begin();
    };
    for (const InputError& error : found_)
        if (rank(error) == static_cast<std::ptrdiff_t>(files.size())) files.push_back(error.place().file);
    std::vector<InputError> sorted = found_;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const InputError& a, const InputError& b) {
        return std::tuple(rank(a), a.place().line, a.place().column) < std::tuple(rank(b), b.place().line, b.place().column);
    });
    throw InputErrors(std::move(sorted));
}

}  // namespace feldspar
