#include "feldspar/job/rock_files.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "feldspar/base/error.hpp"
#include "feldspar/base/plain_text.hpp"
#include "feldspar/base/units.hpp"

namespace feldspar {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int line, const std::string& problem, const std::string& allowed = {}) {
    throw InputError({file.string(), line, 0, {}}, problem, allowed);
}

std::string names_of(const std::vector<Mineral>& phases) {
    std::string names;
    for (const Mineral& phase : phases) names += (names.empty() ? "" : ", ") + phase.name;
    return names;
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        lines.push_back(line);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return lines;
}

double number_of(std::string_view text, const std::filesystem::path& file, int line) {
    text = trimmed(text);
    const std::optional<double> value = finite_number(text);
    if (!value) fail(file, line, fmt::format("'{}' is not a number", text), "a number such as 12.5");
    return *value;
}

// The whole number that a flag or a code of DXF is; nothing that fits is 0.
int flags_of(double value) { return std::abs(value) < 1e6 ? static_cast<int>(value) : 0; }

double metres(const std::string& unit) { return parse_quantity("1 " + unit, Dimension::length); }

}  // namespace

std::shared_ptr<const PhaseMap> read_phase_map(const std::string& contents, const std::filesystem::path& file,
                                               const std::vector<Mineral>& phases) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, contents.data(), contents.size()) == 0)
        fail(file, 0, fmt::format("is no PNG picture: {}", image.message), "a PNG picture");
    if (image.width > 20000 || image.height > 20000) {
        png_image_free(&image);
        fail(file, 0, fmt::format("is a picture of {} x {} pixels", image.width, image.height), "at most 20000 x 20000");
    }
    const bool by_value = std::any_of(phases.begin(), phases.end(), [](const Mineral& phase) { return phase.value >= 0; });
    constexpr std::size_t densest = 8 * 1032;  // pixels of a bit each in a byte, as deflate packs them at best
    if (static_cast<std::size_t>(image.width) * image.height / densest > contents.size()) {  // before memory is asked for
        png_image_free(&image);
        fail(file, 0, fmt::format("is damaged: {} bytes cannot hold {} x {} pixels", contents.size(), image.width, image.height));
    }
    image.format = PNG_FORMAT_RGB;
    std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0)
        fail(file, 0, fmt::format("cannot be read as a PNG picture: {}", image.message));

    std::map<std::uint32_t, std::int8_t> legend;
    std::string known;
    for (std::size_t p = 0; p < phases.size(); ++p) {
        const auto value = static_cast<std::uint32_t>(phases[p].value);
        const std::uint32_t colour = phases[p].value >= 0 ? value << 16 | value << 8 | value : phases[p].colour;
        if (!legend.emplace(colour, static_cast<std::int8_t>(p)).second)
            fail(file, 0, fmt::format("two minerals have the same {} in the map", by_value ? "value" : "colour"),
                 "one of its own for each");
        known += fmt::format("{}{} {}", known.empty() ? "" : ", ", phases[p].name,
                             phases[p].value >= 0 ? std::to_string(value) : fmt::format("#{:06x}", colour));
    }
    legend.emplace(0U, std::int8_t{-1});
    auto map = std::make_shared<PhaseMap>();
    map->width = static_cast<int>(image.width);
    map->height = static_cast<int>(image.height);
    map->phase.resize(static_cast<std::size_t>(map->width) * map->height);
    for (std::size_t i = 0; i < map->phase.size(); ++i) {
        const std::uint32_t colour = static_cast<std::uint32_t>(pixels[3 * i]) << 16 |
                                     static_cast<std::uint32_t>(pixels[3 * i + 1]) << 8 | pixels[3 * i + 2];
        const auto found = legend.find(colour);
        if (found == legend.end())
            fail(file, 0,
                 fmt::format("the pixel in column {}, row {} has the colour #{:06x}, which is no mineral's", i % image.width + 1,
                             i / image.width + 1, colour),
                 "colours of the legend (" + known + ") and black for nothing");
        map->phase[i] = found->second;
    }
    return map;
}

std::vector<int> read_phase_list(const std::string& contents, const std::filesystem::path& file,
                                 const std::vector<Mineral>& phases) {
    std::vector<int> list;
    int number = 0;
    for (std::string_view line : lines_of(contents)) {
        ++number;
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) continue;
        const auto found = std::find_if(phases.begin(), phases.end(), [&](const Mineral& phase) { return phase.name == line; });
        if (found == phases.end()) fail(file, number, fmt::format("'{}' is not one of the minerals", line), names_of(phases));
        list.push_back(static_cast<int>(found - phases.begin()));
    }
    return list;
}

namespace {

TraceFile read_csv(const std::string& contents, const std::filesystem::path& file, const std::string& unit,
                   const std::string& layer) {
    const double scale = unit.empty() ? 1.0 : metres(unit);
    TraceFile traces;
    std::map<std::string, std::size_t, std::less<>> column;
    std::size_t columns = 0;
    int number = 0, others = 0;
    for (const std::string_view line : lines_of(contents)) {
        ++number;
        if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
        std::vector<std::string_view> cells;
        for (std::size_t begin = 0; begin <= line.size();) {
            const std::size_t end = std::min(line.find(',', begin), line.size());
            cells.push_back(trimmed(line.substr(begin, end - begin)));
            begin = end + 1;
        }
        if (column.empty()) {
            columns = cells.size();
            for (std::size_t i = 0; i < cells.size(); ++i)
                if (!column.emplace(cells[i], i).second)
                    fail(file, number, fmt::format("the head has the column '{}' twice", cells[i]), "each column once");
            for (const char* needed : {"x1", "y1", "x2", "y2"})
                if (!column.contains(needed))
                    fail(file, number, fmt::format("the head has no column '{}'", needed), "x1,y1,x2,y2 and perhaps set");
            if (!layer.empty() && !column.contains("set"))
                fail(file, number, "the head has no column 'set', but a layer is asked for", "x1,y1,x2,y2,set");
            continue;
        }
        if (cells.size() < columns) fail(file, number, fmt::format("{} values for {} columns", cells.size(), columns));
        if (!layer.empty() && cells[column.find("set")->second] != layer) {
            ++others;
            continue;
        }
        const auto value = [&](const char* name) { return scale * number_of(cells[column.find(name)->second], file, number); };
        const Vec2 from{value("x1"), value("y1")}, to{value("x2"), value("y2")};
        if (!std::isfinite(from.x) || !std::isfinite(from.y) || !std::isfinite(to.x) || !std::isfinite(to.y))
            fail(file, number, "a point lies too far away to be a number of metres");
        if (from == to) fail(file, number, "the trace ends where it begins", "two different points");
        traces.lines_m.push_back({from, to});
    }
    if (others > 0)
        traces.remarks.push_back(
            fmt::format("{}: {} traces of other sets than \"{}\" are left out", file.filename().string(), others, layer));
    return traces;
}

// One pair of a DXF file: group code and value.
struct Group {
    int code = 0;
    std::string_view value;
    int line = 0;
};

std::vector<Group> groups_of(const std::string& contents, const std::filesystem::path& file) {
    const std::vector<std::string_view> lines = lines_of(contents);
    std::vector<Group> groups;
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2) {
        const std::string_view code = trimmed(lines[i]);
        const std::optional<int> value = whole_number<int>(code);
        if (!value)
            fail(file, static_cast<int>(i) + 1, fmt::format("'{}' is no group code", code),
                 "an ASCII DXF file: a code on one line, its value on the next");
        groups.push_back({*value, trimmed(lines[i + 1]), static_cast<int>(i) + 2});
    }
    return groups;
}

TraceFile read_dxf(const std::string& contents, const std::filesystem::path& file, const std::string& unit,
                   const std::string& layer) {
    const std::vector<Group> groups = groups_of(contents, file);
    double scale = unit.empty() ? 0.0 : metres(unit);
    TraceFile traces;
    std::map<std::string, int> skipped;
    int others = 0;
    bool in_entities = false;
    std::vector<Vec2> polyline;  // of a POLYLINE whose vertices follow
    bool open_polyline = false, closed = false, wanted = true;
    const auto keep = [&](std::vector<Vec2> line, bool close, int at) {
        if (close && line.size() > 2) line.push_back(line.front());
        if (line.size() < 2) fail(file, at, "a trace of one point", "two points or more");
        for (Vec2& p : line) p = scale * p;
        if (std::adjacent_find(line.begin(), line.end(), [](Vec2 a, Vec2 b) { return !(a == b); }) == line.end())
            fail(file, at, "the trace ends where it begins", "two different points");
        line.erase(std::unique(line.begin(), line.end(), [](Vec2 a, Vec2 b) { return a == b; }), line.end());  // drawn twice
        for (const Vec2 p : line)
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) fail(file, at, "a point lies too far away to be a number of metres");
        traces.lines_m.push_back(std::move(line));
    };
    const auto require_scale = [&](int at) {
        if (scale == 0.0)
            fail(file, at, "the file does not say its unit of length ($INSUNITS)", "the key unit = \"mm\" beside file");
    };
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const Group& group = groups[i];
        if (group.code == 9 && group.value == "$INSUNITS" && unit.empty() && i + 1 < groups.size()) {
            static const std::map<int, double> sizes{{1, 0.0254}, {2, 0.3048}, {4, 1e-3}, {5, 1e-2}, {6, 1.0}, {7, 1e3}};
            const auto found = sizes.find(flags_of(number_of(groups[i + 1].value, file, groups[i + 1].line)));
            if (found != sizes.end()) scale = found->second;
        }
        if (group.code == 2 && i > 0 && groups[i - 1].value == "SECTION") in_entities = group.value == "ENTITIES";
        if (group.code == 0 && group.value == "ENDSEC") in_entities = false;
        if (group.code != 0 || !in_entities || group.value == "ENDSEC" || group.value == "SECTION") continue;
        // the groups of this entity
        std::size_t end = i + 1;
        while (end < groups.size() && groups[end].code != 0) ++end;
        std::string of_layer;
        std::vector<Vec2> points;
        double x2 = 0.0, y2 = 0.0;
        int flags = 0;
        for (std::size_t k = i + 1; k < end; ++k) {
            const auto value = [&] { return number_of(groups[k].value, file, groups[k].line); };
            switch (groups[k].code) {
                case 8:
                    of_layer = groups[k].value;
                    break;
                case 10:
                    points.push_back({value(), 0.0});
                    break;
                case 20:
                    if (!points.empty()) points.back().y = value();
                    break;
                case 11:
                    x2 = value();
                    break;
                case 21:
                    y2 = value();
                    break;
                case 42:
                    if ((group.value == "LWPOLYLINE" || group.value == "VERTEX") && value() != 0.0)
                        fail(file, groups[k].line, "a polyline with an arc", "straight segments");
                    break;
                case 70:
                    flags = flags_of(value());
                    break;
                default:
                    break;
            }
        }
        const bool of_wanted = layer.empty() || of_layer == layer;
        if (group.value == "LINE") {
            require_scale(group.line);
            if (points.empty()) fail(file, group.line, "a LINE without a first point");
            if (of_wanted)
                keep({points.front(), {x2, y2}}, false, group.line);
            else
                ++others;
        } else if (group.value == "LWPOLYLINE") {
            require_scale(group.line);
            if (of_wanted)
                keep(points, (flags & 1) != 0, group.line);
            else
                ++others;
        } else if (group.value == "POLYLINE") {
            require_scale(group.line);
            open_polyline = true;
            closed = (flags & 1) != 0;
            wanted = of_wanted;
            polyline.clear();
        } else if (group.value == "VERTEX" && open_polyline) {
            if (!points.empty()) polyline.push_back(points.front());
        } else if (group.value == "SEQEND" && open_polyline) {
            if (wanted)
                keep(polyline, closed, group.line);
            else
                ++others;
            open_polyline = false;
        } else if (of_wanted) {
            ++skipped[std::string(group.value)];
        }
    }
    for (const auto& [kind, count] : skipped)
        traces.remarks.push_back(
            fmt::format("{}: {} of {} are no traces and are left out", file.filename().string(), count, kind));
    if (others > 0)
        traces.remarks.push_back(
            fmt::format("{}: {} traces of other layers than \"{}\" are left out", file.filename().string(), others, layer));
    return traces;
}

}  // namespace

TraceFile read_traces(const std::string& contents, const std::filesystem::path& file, const std::string& unit,
                      const std::string& layer) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".csv" && ending != ".dxf")
        fail(file, 0, "is neither CSV nor DXF by its name", "a file that ends with .csv or .dxf");
    TraceFile traces = ending == ".csv" ? read_csv(contents, file, unit, layer) : read_dxf(contents, file, unit, layer);
    if (traces.lines_m.empty())
        fail(file, 0, layer.empty() ? "has no trace" : fmt::format("has no trace of \"{}\"", layer), "one trace or more");
    return traces;
}

}  // namespace feldspar
