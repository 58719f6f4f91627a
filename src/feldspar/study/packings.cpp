#include "feldspar/study/packings.hpp"

#include <fmt/format.h>

#include "feldspar/base/error.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

// Numbers and words, one a line, with every digit. Lists begin with how many there are and words with their length, so that no
// two definitions have the same text.
class Text {
public:
    void add(double number) { text_ += format_exact(number) + '\n'; }
    void add(const std::string& word) { text_ += fmt::format("{} {}\n", word.size(), word); }
    template <class Items, class AddItem>
    void add(const Items& items, AddItem add_item) {
        add(static_cast<double>(items.size()));
        for (const auto& item : items) add_item(item);
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

}  // namespace

// Takes each struct apart by name: one that gets another member is not compiled until the member stands here.
std::string identity_of(const SpecimenSpec& spec, std::uint64_t seed) {
    const auto& [outline, thickness_m, grain_sizes, porosity, merge_length_m, triangles_per_grain, packing_file,
                 particles_per_grain, crystal_sizes, given_cells, phase_sizes] = spec;
    const auto& [shape, width_m, height_m, diameter_m, hole_diameter_m, vertices_m, edge_labels, arcs, flat_angle_rad, holes,
                 notches, labels] = outline;
    Text text;
    text.add(std::to_string(seed));
    text.add(static_cast<int>(shape));
    for (const double number : {width_m, height_m, diameter_m, hole_diameter_m, flat_angle_rad, thickness_m}) text.add(number);
    text.add(vertices_m, [&](Vec2 vertex) {
        text.add(vertex.x);
        text.add(vertex.y);
    });
    text.add(edge_labels, [&](const std::string& label) { text.add(label); });
    if (!arcs.empty())  // identities of outlines without arcs stay as they were
        text.add(arcs, [&](const ArcSpec& arc) {
            const auto& [edge, through] = arc;
            text.add(edge);
            text.add(through.x);
            text.add(through.y);
        });
    const auto add_point = [&](Vec2 point) {
        text.add(point.x);
        text.add(point.y);
    };
    text.add(holes, [&](const HoleSpec& hole) {
        const auto& [centre, hole_diameter, corners, label] = hole;
        add_point(centre);
        text.add(hole_diameter);
        text.add(corners, add_point);
        text.add(label);
    });
    text.add(notches, [&](const NotchSpec& notch) {
        const auto& [from, to, width, label, joined] = notch;
        add_point(from);
        add_point(to);
        text.add(width);
        text.add(label);
        if (joined) text.add(std::string("joined"));
    });
    text.add(labels, [&](const PlaceLabelSpec& label) {
        const auto& [name, place, a, b, within] = label;
        text.add(name);
        text.add(static_cast<int>(place));
        add_point(a);
        add_point(b);
        text.add(within);
    });
    const auto add_sizes = [&](const GrainSizeSpec& sizes, double of_porosity) {
        const auto& [kind, minimum_m, maximum_m, median_m, log_standard_deviation, sieve] = sizes;
        text.add(static_cast<int>(kind));
        for (const double number : {minimum_m, maximum_m, median_m, log_standard_deviation, of_porosity}) text.add(number);
        text.add(sieve, [&](const SievePoint& point) {
            const auto& [diameter, passing] = point;
            text.add(diameter);
            text.add(passing);
        });
    };
    if (phase_sizes.empty())
        add_sizes(grain_sizes, porosity);  // else they are the mixture of these
    else {
        text.add(porosity);
        text.add(phase_sizes, [&](const PhaseSizes& phase) {
            const auto& [name, share, sizes] = phase;
            text.add(name);
            text.add(share);
            add_sizes(sizes, 0.0);
        });
    }
    if (crystal_sizes) add_sizes(*crystal_sizes, 0.0);  // identities of specimens without crystals stay as they were
    if (merge_length_m)
        text.add(*merge_length_m);
    else
        text.add(std::string("usual"));
    text.add(triangles_per_grain);
    text.add(packing_file.string());
    text.add(particles_per_grain);
    if (given_cells.given()) {
        const auto& [file, unit_m, tolerance, cut, hash, cells] = given_cells;
        text.add(hash);
        text.add(unit_m);
        text.add(tolerance);
        text.add(cut ? 1.0 : 0.0);
    }
    return hash_of_text(text.text());
}

std::shared_ptr<const Specimen> Packings::get(const SpecimenSpec& spec, std::uint64_t seed, int threads, const Tell& tell) {
    const std::string key = identity_of(spec, seed);
    std::promise<std::shared_ptr<const Specimen>> promise;
    std::unique_lock lock(mutex_);
    std::erase(used_, key);
    used_.push_back(key);
    if (const auto found = made_.find(key); found != made_.end()) {
        const Made made = found->second;
        lock.unlock();
        return made.get();
    }
    const Made made = promise.get_future().share();
    made_[key] = made;
    for (; used_.size() > kept_; used_.pop_front()) made_.erase(used_.front());
    lock.unlock();
    try {
        SpecimenControl control;
        control.threads = threads;
        control.progress = [&](const SpecimenProgress& progress) {
            if (stop_ != nullptr && *stop_) throw Interrupted();
            if (tell) tell(progress);
        };
        promise.set_value(std::make_shared<const Specimen>(make_specimen(spec, seed, control)));
    } catch (...) {
        promise.set_exception(std::current_exception());
        throw;
    }
    return made.get();
}

}  // namespace feldspar
