// A packing as text, so that it can be kept, exchanged and loaded again with the same bits.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <exception>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "feldspar/base/error.hpp"
#include "feldspar/base/plain_text.hpp"
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/specimen.hpp"

namespace feldspar {
namespace {

constexpr const char* first_line = "feldspar packing 1";

/// Reads line by line, and knows the line for error messages.
class PackingReader {
public:
    explicit PackingReader(const std::filesystem::path& file) : name_(file.string()), stream_(file) {
        if (!stream_) throw InputError({name_, 0, 0, ""}, "the packing file cannot be opened", "a file saved with save_packing");
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored))
            throw InputError({name_, 0, 0, ""}, "is no file of a packing",
                             "a file saved with save_packing");  // a device has no end
    }

    [[noreturn]] void fail(const std::string& problem, const std::string& allowed) const {
        throw InputError({name_, line_, line_ > 0 ? 1 : 0, ""}, problem, allowed);
    }

    /// The first word of the next line, which stays to be read; empty at the end.
    std::string next_word() {
        const std::streampos here = stream_.tellg();
        std::string text, word;
        if (std::getline(stream_, text)) std::istringstream(text) >> word;
        stream_.clear();
        stream_.seekg(here);
        return word;
    }

    /// The words of the next line. `what` says what should stand there.
    std::vector<std::string> next(const std::string& what) {
        std::string text;
        ++line_;
        if (!std::getline(stream_, text)) fail("the file ends too early", what);
        text_ = text;
        std::istringstream words(text);
        std::vector<std::string> result;
        for (std::string word; words >> word;) result.push_back(word);
        return result;
    }

    /// The numbers of the next line, which must start with `keyword` (if not empty) and hold `count` finite numbers.
    std::vector<double> numbers(const std::string& keyword, std::size_t count) {
        const std::string what =
            keyword.empty() ? fmt::format("{} numbers", count) : fmt::format("'{}' and {} numbers", keyword, count);
        std::vector<std::string> words = next(what);
        if (!keyword.empty()) {
            if (words.empty() || words[0] != keyword) fail(fmt::format("'{}'", text_), what);
            words.erase(words.begin());
        }
        if (words.size() != count) fail(fmt::format("'{}'", text_), what);
        std::vector<double> result;
        for (const std::string& word : words) {
            const std::optional<double> value = finite_number(word);
            if (!value) fail(fmt::format("'{}' is not a number", word), what);
            result.push_back(*value);
        }
        return result;
    }

    /// A count at least `least`, from a line `keyword` n.
    std::size_t count(const std::string& keyword, double least) {
        const double value = numbers(keyword, 1)[0];
        if (value != std::floor(value) || value < least || value > 1e8) fail(fmt::format("'{}'", text_), "a whole number");
        return static_cast<std::size_t>(value);
    }

private:
    std::string name_;
    std::ifstream stream_;
    std::string text_;
    int line_ = 0;
};

std::string outer_text(const Outline& outline) {
    if (outline.flattened())
        return fmt::format("flattened-disc {:.17g} {:.17g} {:.17g} {:.17g}\n", outline.centre.x, outline.centre.y,
                           outline.radius_m, outline.flat_height_m);
    if (outline.is_disc)
        return fmt::format("disc {:.17g} {:.17g} {:.17g}\n", outline.centre.x, outline.centre.y, outline.radius_m);
    std::string text = fmt::format("polygon {}\n", outline.vertices.size());
    for (const Vec2 v : outline.vertices) text += fmt::format("{:.17g} {:.17g}\n", v.x, v.y);
    return text;
}

/// What discs are packed around belongs to the packing; what is cut out of the cells afterwards does not.
std::vector<const Cutout*> packed_around(const Outline& outline) {
    std::vector<const Cutout*> result;
    for (const Cutout& cutout : outline.cutouts) {
        if (cutout.packed_around) result.push_back(&cutout);
    }
    return result;
}

std::string outline_text(const Outline& outline) {
    std::string text = outer_text(outline);
    for (const Cutout* cutout : packed_around(outline)) {
        text += fmt::format("without {}\n", cutout->vertices.size());
        for (const Vec2 v : cutout->vertices) text += fmt::format("{:.17g} {:.17g}\n", v.x, v.y);
    }
    return text;
}

void require_same_cutouts(PackingReader& reader, const Outline& outline, double tolerance) {
    const std::vector<const Cutout*> cutouts = packed_around(outline);
    for (std::size_t k = 0; k < cutouts.size(); ++k) {
        const Cutout& cutout = *cutouts[k];
        const std::string allowed =
            fmt::format("a packing around {} of {} corners, as this specimen has it", cutout.name, cutout.vertices.size());
        if (reader.next_word() != "without") {
            reader.next(allowed);
            reader.fail(k == 0 ? "the packing was made without holes or wide notches"
                               : fmt::format("the packing was made with {} holes and wide notches", k),
                        allowed);
        }
        if (reader.count("without", 3) != cutout.vertices.size())
            reader.fail("the packing was made for a hole or notch of another number of corners", allowed);
        for (const Vec2 v : cutout.vertices) {
            const auto xy = reader.numbers("", 2);
            if (norm(Vec2{xy[0], xy[1]} - v) > tolerance)
                reader.fail(
                    fmt::format("the packing was made for a hole or notch with a corner at ({:.9g}, {:.9g}) m", xy[0], xy[1]),
                    fmt::format("this specimen's corner of {} at ({:.9g}, {:.9g}) m", cutout.name, v.x, v.y));
        }
    }
    if (reader.next_word() != "without") return;
    reader.next("");
    reader.fail(fmt::format("the packing was made around {} holes or wide notches and more", cutouts.size()),
                fmt::format("{}, as this specimen has", cutouts.size()));
}

void require_same_outer(PackingReader& reader, const Outline& outline) {
    const Box box = bounding_box(outline);
    const double tolerance = 1e-9 * norm(box.upper - box.lower);
    const auto same = [&](Vec2 a, Vec2 b) { return norm(a - b) <= tolerance; };
    if (outline.flattened()) {
        const auto disc = reader.numbers("flattened-disc", 4);
        const bool same_lengths =
            std::abs(disc[2] - outline.radius_m) <= tolerance && std::abs(disc[3] - outline.flat_height_m) <= tolerance;
        if (!same({disc[0], disc[1]}, outline.centre) || !same_lengths) {
            const auto in_words = [](double radius_m, double flat_m) {
                return fmt::format("a disc of radius {:.9g} m with flats {:.9g} m from its centre", radius_m, flat_m);
            };
            reader.fail("the packing was made for " + in_words(disc[2], disc[3]),
                        "the outline of this specimen: " + in_words(outline.radius_m, outline.flat_height_m));
        }
        return;
    }
    if (outline.is_disc) {
        const auto disc = reader.numbers("disc", 3);
        if (!same({disc[0], disc[1]}, outline.centre) || std::abs(disc[2] - outline.radius_m) > tolerance) {
            reader.fail(fmt::format("the packing was made for a disc of radius {:.9g} m", disc[2]),
                        fmt::format("the outline of this specimen: a disc of radius {:.9g} m", outline.radius_m));
        }
        return;
    }
    const std::size_t n = reader.count("polygon", 3);
    if (n != outline.vertices.size()) {
        reader.fail(fmt::format("the packing was made for an outline of {} vertices", n),
                    fmt::format("this specimen's outline of {} vertices", outline.vertices.size()));
    }
    for (const Vec2 v : outline.vertices) {
        const auto xy = reader.numbers("", 2);
        if (!same({xy[0], xy[1]}, v)) {
            reader.fail(fmt::format("the packing was made for an outline with a vertex at ({:.9g}, {:.9g}) m", xy[0], xy[1]),
                        fmt::format("this specimen's vertex at ({:.9g}, {:.9g}) m", v.x, v.y));
        }
    }
}

void require_same_outline(PackingReader& reader, const Outline& outline) {
    require_same_outer(reader, outline);
    const Box box = bounding_box(outline);
    require_same_cutouts(reader, outline, 1e-9 * norm(box.upper - box.lower));
}

}  // namespace

void save_packing(const Specimen& specimen, const std::filesystem::path& file) {
    const Packing& packing = specimen.packed.centres.empty() ? specimen.packing : specimen.packed;
    std::string text = fmt::format("{}\nseed {}\n{}", first_line, specimen.seed, outline_text(specimen.outline));
    text += fmt::format("relaxation {:.17g} {:.17g} {:.17g} {}\n", packing.overlap_mean, packing.overlap_max, packing.residual,
                        packing.relaxation_steps);
    const bool phased = !packing.phases.empty();
    if (phased) {
        text += fmt::format("minerals {}\n", packing.phase_names.size());
        for (const std::string& name : packing.phase_names) text += name + "\n";
    }
    text += fmt::format("discs {}\n", packing.centres.size());
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
        text += fmt::format("{:.17g} {:.17g} {:.17g}", packing.centres[i].x, packing.centres[i].y, packing.radii_m[i]);
        text += phased ? fmt::format(" {}\n", packing.phases[i]) : "\n";
    }
    text += "end\n";
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    if (stream) return;
    const std::system_error reason(errno != 0 ? errno : EIO, std::generic_category());
    try {
        throw reason;
    } catch (const std::system_error&) {
        std::throw_with_nested(
            OutputError(fmt::format("the packing could not be written to {}: {}", file.string(), reason.code().message())));
    }
}

Packing load_packing(const std::filesystem::path& file, const Outline& outline) {
    PackingReader reader(file);
    const std::vector<std::string> head = reader.next(first_line);
    if (head != std::vector<std::string>{"feldspar", "packing", "1"}) reader.fail("this is not a packing file", first_line);
    const std::vector<std::string> seed = reader.next("'seed' and a number");
    if (seed.size() != 2 || seed[0] != "seed") reader.fail("the seed is missing", "'seed' and a number");
    require_same_outline(reader, outline);

    Packing packing;
    const auto relaxation = reader.numbers("relaxation", 4);
    packing.overlap_mean = relaxation[0];
    packing.overlap_max = relaxation[1];
    packing.residual = relaxation[2];
    if (relaxation[3] != std::floor(relaxation[3]) || !(relaxation[3] >= 0.0 && relaxation[3] < 1e9))
        reader.fail(fmt::format("'{}' is no number of steps", relaxation[3]), "a whole number, zero or more");
    packing.relaxation_steps = static_cast<int>(relaxation[3]);
    if (reader.next_word() == "minerals") {
        const std::size_t minerals = reader.count("minerals", 1);
        for (std::size_t p = 0; p < minerals; ++p) {
            const std::vector<std::string> words = reader.next("the name of a mineral");
            if (words.size() != 1 ||
                std::find(packing.phase_names.begin(), packing.phase_names.end(), words.front()) != packing.phase_names.end())
                reader.fail("this is not the name of a mineral", "a word, each mineral once");
            packing.phase_names.push_back(words.front());
        }
    }
    const bool phased = !packing.phase_names.empty();
    const std::size_t discs = reader.count("discs", 1);
    for (std::size_t i = 0; i < discs; ++i) {
        const auto disc = reader.numbers("", phased ? 4 : 3);
        const Vec2 centre = {disc[0], disc[1]};
        if (!contains(outline, centre))
            reader.fail(fmt::format("the centre of disc {} lies outside the outline", i), "a centre inside");
        if (!(disc[2] > 0.0))
            reader.fail(fmt::format("the radius of disc {} is {:g} m", i, disc[2]), "a radius greater than zero");
        packing.centres.push_back(centre);
        packing.radii_m.push_back(disc[2]);
        if (!phased) continue;
        if (disc[3] != std::floor(disc[3]) || disc[3] < 0.0 || disc[3] >= static_cast<double>(packing.phase_names.size()))
            reader.fail(fmt::format("the mineral of disc {} is {:g}", i, disc[3]),
                        fmt::format("from 0 to {}", packing.phase_names.size() - 1));
        packing.phases.push_back(static_cast<int>(disc[3]));
    }
    if (reader.next("'end'") != std::vector<std::string>{"end"}) reader.fail("more lines than discs", "'end'");
    return packing;
}

}  // namespace feldspar
