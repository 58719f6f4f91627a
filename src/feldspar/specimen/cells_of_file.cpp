#include "feldspar/specimen/cells_of_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "feldspar/base/error.hpp"
#include "feldspar/base/plain_text.hpp"

namespace feldspar {
namespace {

constexpr std::size_t largest_file = std::size_t{1} << 30;
constexpr long long most_things = 50'000'000;  // of one kind in a file; beyond it a count is damaged

// Other programs write a plus sign, too.
std::optional<double> signed_number(std::string_view word) {
    return finite_number(word.starts_with('+') ? word.substr(1) : word);
}

/// The words of a text, one after the other, each with its line.
class Words {
public:
    Words(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file.string()) {}

    [[noreturn]] void fail(int line, const std::string& problem, const std::string& allowed = {}) const {
        throw InputError({file_, line, line > 0 ? 1 : 0, {}}, problem, allowed);
    }
    [[noreturn]] void fail(const std::string& problem, const std::string& allowed = {}) const { fail(line_, problem, allowed); }

    /// The next word, which stays to be read; empty at the end.
    std::string_view peek() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
            if (text_[at_] == '\n') ++next_line_;
            ++at_;
        }
        std::size_t end = at_;
        while (end < text_.size() && std::isspace(static_cast<unsigned char>(text_[end])) == 0) ++end;
        return text_.substr(at_, end - at_);
    }
    /// @param what  stands there, for the message at the end of the file
    std::string_view next(std::string_view what) {
        const std::string_view word = peek();
        line_ = next_line_;
        if (word.empty()) fail("the file ends too early", std::string(what));
        at_ += word.size();
        return word;
    }
    /// The line of the last word.
    int line() const { return line_; }

    double number(std::string_view what) {
        const std::string_view word = next(what);
        const std::optional<double> value = signed_number(word);
        if (!value) fail(fmt::format("'{}' is not a number", clipped(word)), std::string(what));
        return *value;
    }
    long long whole(std::string_view what) {
        const std::string_view word = next(what);
        const std::optional<long long> value = whole_number(word);
        if (!value) fail(fmt::format("'{}' is not a whole number", clipped(word)), std::string(what));
        return *value;
    }
    /// A count, from `least` on.
    long long count(std::string_view what, long long least = 0) {
        const long long value = whole(what);
        if (value < least || value > most_things)
            fail(fmt::format("{} is no count", value), fmt::format("{}, from {} to {}", what, least, most_things));
        return value;
    }
    /// A number of something, from 1 to `last`.
    int index(std::string_view what, std::size_t last) {
        const long long value = whole(what);
        if (value < 1 || value > static_cast<long long>(last))
            fail(fmt::format("there is no {} {}", what, value),
                 last == 0 ? fmt::format("the file has no {}", what) : fmt::format("from 1 to {}", last));
        return static_cast<int>(value);
    }
    /// The number that must stand here, as things are numbered one after the other.
    void numbered(std::string_view what, long long number) {
        const long long value = whole(what);
        if (value != number)
            fail(fmt::format("{} {} stands where number {} should be", what, value, number),
                 "numbers from 1 on, one after the other");
    }
    /// The rest of the line.
    void skip_line() {
        const std::size_t end = text_.find('\n', at_);
        at_ = end == std::string_view::npos ? text_.size() : end;
    }
    static std::string clipped(std::string_view word) {
        std::string text(word.substr(0, 40));
        for (char& c : text)
            if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
        return text + (word.size() > 40 ? "..." : "");
    }

private:
    std::string_view text_;
    std::string file_;
    std::size_t at_ = 0;
    int line_ = 1, next_line_ = 1;
};

/// Coordinates in the plane. The third one must say so: within a millionth of the extent, which is checked at the end.
class PlaneCheck {
public:
    void take(Vec2 at, double z, int line) {
        extent_ = std::max({extent_, std::abs(at.x), std::abs(at.y)});
        if (std::abs(z) <= std::abs(worst_)) return;
        worst_ = z;
        line_ = line;
    }
    void require(const Words& words) const {
        if (std::abs(worst_) > 1e-6 * extent_)
            words.fail(line_, fmt::format("a point lies at z = {:g}, outside the plane", worst_),
                       "points with z = 0: Feldspar is two-dimensional");
    }

private:
    double extent_ = 0.0, worst_ = 0.0;
    int line_ = 0;
};

// Neper's .tess

class TessReader {
public:
    TessReader(std::string_view contents, const std::filesystem::path& file) : words_(contents, file) {}

    CellsOfFile read() {
        if (words_.peek() != "***tess") {
            const std::string first(words_.next("***tess"));
            const bool raster = first == "***tesr";
            words_.fail(raster ? "is a raster tessellation"
                               : fmt::format("begins with '{}': this is no tessellation file of Neper", Words::clipped(first)),
                        raster ? "a tessellation with vertices and edges (***tess)" : "***tess");
        }
        words_.next("***tess");
        std::set<std::string, std::less<>> seen;
        for (;;) {
            const std::string section(words_.next("***end"));
            if (section == "***end") break;
            if (!section.starts_with("**") || section.starts_with("***"))
                words_.fail(fmt::format("'{}' stands where a section should begin", Words::clipped(section)),
                            "**format, **general, **cell, **vertex, **edge, **face, **domain, ... or ***end");
            if (!seen.insert(section).second)
                words_.fail(fmt::format("the section {} is there twice", Words::clipped(section)), "each section once");
            read_section(section);
        }
        if (!words_.peek().empty()) {
            words_.next("");
            words_.fail("something stands behind ***end", "nothing");
        }
        for (const char* needed : {"**general", "**cell", "**vertex", "**edge", "**face"})
            if (!seen.contains(needed))
                words_.fail(0, fmt::format("the section {} is missing", needed),
                            "**format, **general, **cell, **vertex, **edge and **face");
        plane_.require(words_);
        if (faces_.size() != static_cast<std::size_t>(cells_))
            words_.fail(face_count_line_, fmt::format("{} faces for {} cells", faces_.size(), cells_),
                        "as many faces as cells: in two dimensions each cell is a face");
        check_faces();
        if (!skipped_.empty()) {
            std::string list;
            for (const std::string& name : skipped_) list += (list.empty() ? "" : ", ") + name;
            result_.remarks.push_back(fmt::format("fields of **cell that are not known were passed over: {}", list));
        }
        return std::move(result_);
    }

private:
    struct Edge {
        int a, b;
    };
    struct FaceOfFile {
        int line = 0;
        std::vector<int> vertices;     // from 1 on
        std::vector<long long> edges;  // signed
    };

    void read_section(const std::string& section) {
        if (section == "**format") {
            const std::string_view version = words_.next("a version such as 3.5");
            if (!version.starts_with("2.") && !version.starts_with("3.") && version != "2" && version != "3")
                words_.fail(fmt::format("version '{}' of the format is not known", Words::clipped(version)),
                            "versions 2.0 to 3.5");
        } else if (section == "**general") {
            const long long dimension = words_.whole("the dimension");
            if (dimension == 3)
                words_.fail("the tessellation is three-dimensional: Feldspar breaks rock in the plane",
                            "a tessellation of dimension 2 (neper -T -dim 2, or a slice of this one: neper -T -loadtess ... "
                            "-transform slice)");
            if (dimension != 2) words_.fail(fmt::format("the tessellation has the dimension {}", dimension), "2");
            words_.next("the type, 'standard'");
        } else if (section == "**cell") {
            read_cells();
        } else if (section == "**vertex") {
            const long long n = words_.count("a number of vertices", 3);
            for (long long i = 1; i <= n; ++i) {
                words_.numbered("vertex", i);
                const Vec2 at{words_.number("x of a vertex"), words_.number("y of a vertex")};
                plane_.take(at, words_.number("z of a vertex"), words_.line());
                words_.whole("the state of a vertex");
                result_.vertices.push_back(at);
            }
        } else if (section == "**edge") {
            const long long n = words_.count("a number of edges", 3);
            for (long long i = 1; i <= n; ++i) {
                words_.numbered("edge", i);
                edge_lines_.push_back(words_.line());
                const int a = static_cast<int>(words_.count("a vertex")), b = static_cast<int>(words_.count("a vertex"));
                edges_.push_back({a, b});
                words_.whole("the state of an edge");
            }
        } else if (section == "**face") {
            read_faces();
        } else if (section == "**domain" || section == "**periodicity" || section == "**periodic" || section == "**scale" ||
                   section == "**polyhedron") {
            while (!words_.peek().starts_with("**")) words_.next("***end");
        } else {
            words_.fail(fmt::format("the section '{}' is not known", Words::clipped(section)),
                        "**format, **general, **cell, **vertex, **edge, **face, **domain, **periodic, **scale");
        }
    }

    void read_cells() {
        cells_ = words_.count("a number of cells", 1);
        static const std::set<std::string_view> known{"*id",  "*seed",  "*ori",  "*orispread", "*orispreadtheta", "*weight",
                                                      "*lam", "*lamid", "*mode", "*modeid",    "*group",          "*crysym"};
        while (words_.peek().starts_with('*') && !words_.peek().starts_with("**")) {
            const std::string field(words_.next("a field of **cell"));
            if (field == "*id") {
                for (long long i = 0; i < cells_; ++i) names_.push_back(std::to_string(words_.whole("the number of a cell")));
                continue;
            }
            if (!known.contains(field)) skipped_.insert(Words::clipped(field));
            while (!words_.peek().starts_with('*')) words_.next("***end");
        }
    }

    void read_faces() {
        const long long n = words_.count("a number of faces", 1);
        face_count_line_ = words_.line();
        for (long long i = 1; i <= n; ++i) {
            FaceOfFile face;
            words_.numbered("face", i);
            face.line = words_.line();
            const long long corners = words_.count("a number of vertices of a face");
            if (corners < 3) words_.fail(fmt::format("face {} has {} vertices", i, corners), "three or more");
            for (long long k = 0; k < corners; ++k) face.vertices.push_back(static_cast<int>(words_.count("a vertex of a face")));
            const long long edges = words_.count("a number of edges of a face");
            if (edges != corners)
                words_.fail(fmt::format("face {} has {} edges for {} vertices", i, edges, corners), "as many edges as vertices");
            for (long long k = 0; k < edges; ++k) face.edges.push_back(words_.whole("an edge of a face"));
            for (int k = 0; k < 4; ++k) words_.number("the equation of a face");
            words_.whole("the state of a face");
            words_.whole("the point of a face");
            for (int k = 0; k < 3; ++k) words_.number("the point of a face");
            faces_.push_back(std::move(face));
        }
    }

    /// Vertices and edges of the faces are there, and each edge joins two vertices that follow each other.
    void check_faces() {
        const long long vertices = std::ssize(result_.vertices), edges = std::ssize(edges_);
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const int v : {edges_[e].a, edges_[e].b})
                if (v < 1 || v > vertices)
                    words_.fail(edge_lines_[e], fmt::format("edge {} names vertex {}, which is not there", e + 1, v),
                                fmt::format("vertices 1 to {}", vertices));
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const FaceOfFile& face = faces_[f];
            for (const int v : face.vertices)
                if (v < 1 || v > vertices)
                    words_.fail(face.line, fmt::format("face {} names vertex {}, which is not there", f + 1, v),
                                fmt::format("vertices 1 to {}", vertices));
            std::set<std::pair<int, int>> sides;
            for (std::size_t k = 0; k < face.vertices.size(); ++k)
                sides.insert(std::minmax(face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]));
            for (const long long signed_edge : face.edges) {
                const long long e = std::abs(std::max(signed_edge, -most_things - 1));
                if (e < 1 || e > edges)
                    words_.fail(face.line, fmt::format("face {} names edge {}, which is not there", f + 1, e),
                                fmt::format("edges 1 to {}", edges));
                const Edge& edge = edges_[e - 1];
                if (!sides.contains(std::minmax(edge.a, edge.b)))
                    words_.fail(
                        face.line,
                        fmt::format("edge {} of face {} joins vertices {} and {}, which do not follow each other in the face", e,
                                    f + 1, edge.a, edge.b),
                        "the edges of the face");
            }
            CellsOfFile::Cell cell;
            cell.name = names_.empty() ? std::to_string(f + 1) : names_[f];
            cell.line = face.line;
            for (const int v : face.vertices) cell.corners.push_back(v - 1);
            result_.cells.push_back(std::move(cell));
        }
    }

    Words words_;
    CellsOfFile result_;
    PlaneCheck plane_;
    long long cells_ = 0;
    int face_count_line_ = 0;
    std::vector<std::string> names_;
    std::vector<Edge> edges_;
    std::vector<int> edge_lines_;
    std::vector<FaceOfFile> faces_;
    std::set<std::string> skipped_;
};

// gmsh's .msh

class MshReader {
public:
    MshReader(std::string_view contents, const std::filesystem::path& file) : words_(contents, file) {}

    CellsOfFile read() {
        if (words_.peek().empty()) words_.fail(0, "is empty", "a mesh of gmsh");
        std::set<std::string, std::less<>> seen;
        while (!words_.peek().empty()) {
            const std::string section(words_.next("a section"));
            if (!section.starts_with('$') || section.starts_with("$End"))
                words_.fail(fmt::format("'{}' stands where a section should begin", Words::clipped(section)),
                            "$MeshFormat, $Entities, $Nodes, $Elements, ...");
            if (section != "$MeshFormat" && !seen.contains("$MeshFormat"))
                words_.fail(fmt::format("{} stands before $MeshFormat", Words::clipped(section)), "$MeshFormat at the beginning");
            if (!seen.insert(section).second &&
                (section == "$Nodes" || section == "$Elements" || section == "$Entities" || section == "$MeshFormat"))
                words_.fail(fmt::format("the section {} is there twice", section), "each section once");
            const std::string end = "$End" + section.substr(1);
            if (section == "$MeshFormat")
                read_format();
            else if (section == "$Entities" && version4_)
                read_entities();
            else if (section == "$Nodes")
                read_nodes();
            else if (section == "$Elements")
                read_elements();
            else
                while (words_.peek() != end) words_.next(end);
            if (words_.next(end) != end)
                words_.fail(fmt::format("the section {} does not end where its counts say", section), end);
        }
        for (const char* needed : {"$Nodes", "$Elements"})
            if (!seen.contains(needed))
                words_.fail(0, fmt::format("the section {} is missing", needed), "$MeshFormat, $Nodes and $Elements");
        plane_.require(words_);
        if (elements_.empty())
            words_.fail(0, "has no triangles and quadrangles", "a mesh of surfaces: save it with its elements of dimension 2");
        gather();
        return std::move(result_);
    }

private:
    struct Element {
        int line = 0;
        int physical = 0, elementary = 0;
        std::array<int, 4> nodes{};
        int count = 0;
    };

    void read_format() {
        const std::string version(words_.next("a version"));
        const long long type = words_.whole("0, for a text");
        words_.whole("the size of a number");
        if (type != 0) words_.fail("is a binary mesh", "a mesh saved as text (gmsh: Mesh.Binary = 0, or save as ASCII)");
        version4_ = version == "4.1";
        if (!version4_ && version != "2.2" && version != "2" && version != "2.0" && version != "2.1")
            words_.fail(fmt::format("version {} of the format is not read", Words::clipped(version)),
                        "4.1 or 2.2 (gmsh -format msh41 or msh22)");
    }

    void read_entities() {
        std::array<long long, 4> counts{};
        for (long long& n : counts) n = words_.count("a number of points, curves, surfaces or volumes");
        for (int dimension = 0; dimension < 4; ++dimension) {
            for (long long i = 0; i < counts[dimension]; ++i) {
                const long long tag = words_.whole("the tag of an entity");
                for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) words_.number("a bound of an entity");
                const long long physicals = words_.count("a number of physical tags");
                for (long long k = 0; k < physicals; ++k) {
                    const long long physical = words_.whole("a physical tag");
                    if (dimension == 2 && k == 0) physical_of_surface_[tag] = tag_of(physical);
                }
                if (dimension == 0) continue;
                const long long around = words_.count("a number of bounding entities");
                for (long long k = 0; k < around; ++k) words_.whole("a bounding entity");
            }
        }
    }

    void add_node(long long tag, int line, Vec2 at, double z) {
        plane_.take(at, z, line);
        if (tag < 0) words_.fail(line, fmt::format("a node has the number {}", tag), "a number from 1 on");
        if (!node_of_tag_.emplace(tag, static_cast<int>(result_.vertices.size())).second)
            words_.fail(line, fmt::format("node {} is there twice", tag), "each node once");
        result_.vertices.push_back(at);
    }

    void read_nodes() {
        const auto point = [&](long long tag) {
            const Vec2 at{words_.number("x of a node"), words_.number("y of a node")};
            const double z = words_.number("z of a node");
            add_node(tag, words_.line(), at, z);
        };
        if (!version4_) {
            const long long n = words_.count("a number of nodes", 3);
            for (long long i = 0; i < n; ++i) point(words_.whole("the number of a node"));
            return;
        }
        const long long blocks = words_.count("a number of blocks of nodes"), all = words_.count("a number of nodes", 3);
        words_.whole("the least tag");
        words_.whole("the largest tag");
        for (long long b = 0; b < blocks; ++b) {
            const long long dimension = words_.whole("a dimension");
            words_.whole("the tag of an entity");
            const long long parametric = words_.whole("0 or 1"), n = words_.count("a number of nodes");
            std::vector<long long> tags;
            for (long long i = 0; i < n; ++i) tags.push_back(words_.whole("the tag of a node"));
            for (const long long tag : tags) {
                point(tag);
                for (long long k = 0; parametric == 1 && k < std::clamp<long long>(dimension, 0, 3); ++k)
                    words_.number("a parameter of a node");
            }
        }
        if (std::ssize(result_.vertices) != all)
            words_.fail(fmt::format("{} nodes in the blocks, but {} are announced", result_.vertices.size(), all),
                        "the same number");
    }

    // Nodes of an element of this type; 0: not known.
    static int nodes_of(long long type) {
        static const std::map<long long, int> counts{{1, 2},  {2, 3},  {3, 4},   {4, 4},  {5, 8},   {6, 6},
                                                     {7, 5},  {8, 3},  {9, 6},   {10, 9}, {11, 10}, {15, 1},
                                                     {16, 8}, {20, 9}, {21, 10}, {26, 4}, {27, 5},  {28, 6}};
        const auto found = counts.find(type);
        return found == counts.end() ? 0 : found->second;
    }

    void take_element(long long type, int line, int physical, int elementary) {
        static const std::string allowed = "triangles and quadrangles of first order (types 2 and 3)";
        const int count = nodes_of(type);
        if (count == 0) words_.fail(line, fmt::format("an element has the type {}", type), allowed);
        if (type == 4 || type == 5 || type == 6 || type == 7 || type == 11)
            words_.fail(line, "the mesh has solid elements: Feldspar breaks rock in the plane", allowed);
        if (type == 9 || type == 10 || type == 16 || type == 20 || type == 21)
            words_.fail(line, "the mesh has surface elements of higher order", allowed);
        Element element{line, physical, elementary, {}, 0};
        for (int k = 0; k < count; ++k) {
            const long long tag = words_.whole("a node of an element");
            const auto found = node_of_tag_.find(tag);
            if (found == node_of_tag_.end())
                words_.fail(fmt::format("an element names node {}, which is not there", tag),
                            "nodes of $Nodes, which stand before $Elements");
            if (count == 3 || count == 4) element.nodes[k] = found->second;
        }
        if (type != 2 && type != 3) return;  // points and lines mark boundaries
        element.count = count;
        elements_.push_back(element);
    }

    static int tag_of(long long tag) {
        tag = std::clamp<long long>(tag, -2'000'000'000, 2'000'000'000);
        return static_cast<int>(std::abs(tag));
    }

    void read_elements() {
        if (!version4_) {
            const long long n = words_.count("a number of elements", 1);
            for (long long i = 0; i < n; ++i) {
                words_.whole("the number of an element");
                const int line = words_.line();
                const long long type = words_.whole("the type of an element"), tags = words_.count("a number of tags");
                int physical = 0, elementary = 0;
                for (long long k = 0; k < tags; ++k) {
                    const int tag = tag_of(words_.whole("a tag"));
                    if (k == 0) physical = tag;
                    if (k == 1) elementary = tag;
                }
                if (tags == 1) elementary = physical;
                take_element(type, line, physical, elementary);
            }
            return;
        }
        const long long blocks = words_.count("a number of blocks of elements"), all = words_.count("a number of elements", 1);
        words_.whole("the least tag");
        words_.whole("the largest tag");
        long long read = 0;
        for (long long b = 0; b < blocks; ++b) {
            words_.whole("a dimension");
            const long long tag = words_.whole("the tag of an entity"), type = words_.whole("the type of elements"),
                            n = words_.count("a number of elements");
            const auto found = physical_of_surface_.find(tag);
            for (long long i = 0; i < n; ++i) {
                words_.whole("the tag of an element");
                take_element(type, words_.line(), found == physical_of_surface_.end() ? 0 : found->second, tag_of(tag));
                ++read;
            }
        }
        if (read != all)
            words_.fail(fmt::format("{} elements in the blocks, but {} are announced", read, all), "the same number");
    }

    /// Which tags are the grains; then the polygon of each.
    void gather() {
        std::set<int> physicals;
        for (const Element& element : elements_) physicals.insert(element.physical);
        const bool physical = !physicals.contains(0) && physicals.size() > 1;
        std::map<int, std::vector<const Element*>> grains;
        for (const Element& element : elements_) grains[physical ? element.physical : element.elementary].push_back(&element);
        result_.remarks.push_back(fmt::format("grains are the {} surfaces of the mesh", physical ? "physical" : "elementary"));
        for (const auto& [tag, elements] : grains) result_.cells.push_back(polygon_of(tag, elements));
    }

    double twice_area(const Element& e) const {
        double sum = 0.0;
        for (int k = 0; k < e.count; ++k)
            sum += cross(result_.vertices[e.nodes[k]],
                         result_.vertices[static_cast<std::size_t>(e.nodes[static_cast<std::size_t>((k + 1) % e.count)])]);
        return sum;
    }

    CellsOfFile::Cell polygon_of(int tag, const std::vector<const Element*>& elements) const {
        std::map<std::pair<int, int>, int> darts;  // directed sides, each counter-clockwise around its element: how often
        for (const Element* element : elements) {
            const bool turned = twice_area(*element) < 0.0;
            for (int k = 0; k < element->count; ++k) {
                int a = element->nodes[k], b = element->nodes[static_cast<std::size_t>((k + 1) % element->count)];
                if (turned) std::swap(a, b);
                if (a == b)
                    words_.fail(element->line, fmt::format("an element of surface {} names a node twice", tag),
                                "different nodes");
                if (const auto other = darts.find({b, a}); other != darts.end()) {
                    darts.erase(other);
                } else if (!darts.emplace(std::pair{a, b}, element->line).second) {
                    words_.fail(element->line, fmt::format("elements of surface {} lie on each other", tag),
                                "elements side by side");
                }
            }
        }
        std::map<int, int> after;
        const int line = elements.front()->line;
        const auto place = [&](int v) { return fmt::format("({:.9g}, {:.9g})", result_.vertices[v].x, result_.vertices[v].y); };
        for (const auto& [side, at] : darts)
            if (!after.emplace(side.first, side.second).second)
                words_.fail(at, fmt::format("surface {} hangs together by a point only, at {}", tag, place(side.first)),
                            "a surface of its own for each grain");
        if (after.empty()) words_.fail(line, fmt::format("surface {} has no boundary", tag), "elements side by side");
        CellsOfFile::Cell cell{std::to_string(tag), line, {}};
        const int first = after.begin()->first;
        int v = first;
        do {
            cell.corners.push_back(v);
            v = after.at(v);
        } while (v != first);
        if (cell.corners.size() != after.size()) {
            int other = first;
            for (const auto& [from, to] : after)
                if (std::find(cell.corners.begin(), cell.corners.end(), from) == cell.corners.end()) other = from;
            words_.fail(
                line,
                fmt::format("surface {} is not one grain: its boundary has parts at {} and {}", tag, place(first), place(other)),
                "surfaces without holes, in one piece each");
        }
        remove_straight(cell.corners);
        return cell;
    }

    /// Without the nodes that lie on a straight line between their neighbours.
    void remove_straight(std::vector<int>& corners) const {
        const auto at = [&](int v) { return result_.vertices[v]; };
        const auto straight = [&](int a, int v, int b) {
            const Vec2 along = at(b) - at(a), to = at(v) - at(a);
            return dot(to, along) > 0.0 && dot(at(b) - at(v), along) > 0.0 &&
                   std::abs(cross(along, to)) <= 1e-7 * dot(along, along);
        };
        std::size_t begin = 0;  // at a corner that stays
        const std::size_t n = corners.size();
        while (begin < n && straight(corners[(begin + n - 1) % n], corners[begin], corners[(begin + 1) % n])) ++begin;
        if (begin == n) return;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(begin), corners.end());
        std::vector<int> kept{corners.front()};
        for (std::size_t k = 1; k < n; ++k)
            if (!straight(kept.back(), corners[k], corners[(k + 1) % n])) kept.push_back(corners[k]);
        corners = std::move(kept);
    }

    Words words_;
    CellsOfFile result_;
    PlaneCheck plane_;
    bool version4_ = false;
    std::map<long long, int> physical_of_surface_;
    std::map<long long, int> node_of_tag_;
    std::vector<Element> elements_;
};

// polygons as CSV

class CsvReader {
public:
    CsvReader(std::string_view contents, const std::filesystem::path& file) : contents_(contents), file_(file.string()) {}

    CellsOfFile read() {
        for (std::string_view rest = contents_; !rest.empty();) {
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            ++line_;
            const std::string_view line = trimmed(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
            if (!line.empty() && !line.starts_with('#')) read_row(line);
        }
        if (!head_) fail(0, "is empty", "a head 'grain,x,y' and a row a corner");
        if (result_.cells.empty()) fail(line_, "has no rows behind its head", "a row a corner: grain,x,y");
        end_cell();
        return std::move(result_);
    }

private:
    [[noreturn]] void fail(int line, const std::string& problem, const std::string& allowed = {}) const {
        throw InputError({file_, line, line > 0 ? 1 : 0, {}}, problem, allowed);
    }

    static std::vector<std::string_view> fields_of(std::string_view line) {
        std::vector<std::string_view> fields;
        for (std::size_t begin = 0; begin <= line.size();) {
            const std::size_t end = std::min(line.find(',', begin), line.size());
            std::string_view field = trimmed(line.substr(begin, end - begin));
            if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
            fields.push_back(field);
            begin = end + 1;
        }
        return fields;
    }

    void read_head(const std::vector<std::string_view>& fields) {
        static const std::map<std::string_view, double> units{{"", 0.0},     {"_nm", 1e-9}, {"_um", 1e-6},
                                                              {"_mm", 1e-3}, {"_cm", 1e-2}, {"_m", 1.0}};
        std::array<std::string_view, 2> unit;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const auto take = [&](std::optional<std::size_t>& column) {
                if (column)
                    fail(line_, fmt::format("the head has the column '{}' twice", Words::clipped(fields[i])), "each column once");
                column = i;
            };
            if (fields[i] == "grain")
                take(grain_);
            else if (fields[i].starts_with('x') && units.contains(fields[i].substr(1)))
                take(x_), unit[0] = fields[i].substr(1);
            else if (fields[i].starts_with('y') && units.contains(fields[i].substr(1)))
                take(y_), unit[1] = fields[i].substr(1);
            else
                others_.insert(Words::clipped(fields[i]));
        }
        if (!grain_ || !x_ || !y_)
            fail(line_,
                 fmt::format("the head has no column '{}'", !grain_ ? "grain"
                                                            : !x_   ? "x"
                                                                    : "y"),
                 "grain,x,y, or with the unit: grain,x_mm,y_mm (nm, um, mm, cm, m)");
        if (unit[0] != unit[1]) fail(line_, "x and y have different units", "the same unit, such as x_mm,y_mm");
        result_.unit_m = units.at(unit[0]);
        if (!others_.empty()) {
            std::string list;
            for (const std::string& name : others_) list += (list.empty() ? "" : ", ") + name;
            result_.remarks.push_back(fmt::format("columns that were passed over: {}", list));
        }
        head_ = true;
    }

    double number(std::string_view field) const {
        const std::optional<double> value = signed_number(field);
        if (!value) fail(line_, fmt::format("'{}' is not a number", Words::clipped(field)), "a number such as 12.5");
        return *value;
    }

    void read_row(std::string_view line) {
        const std::vector<std::string_view> fields = fields_of(line);
        if (!head_) return read_head(fields);
        const std::size_t needed = std::max({*grain_, *x_, *y_}) + 1;
        if (fields.size() < needed)
            fail(line_, fmt::format("{} values in the row", fields.size()), fmt::format("{} or more, as the head has", needed));
        const std::string name = Words::clipped(fields[*grain_]);
        if (name.empty()) fail(line_, "the row does not say of which grain it is", "a number or a name");
        if (result_.cells.empty() || result_.cells.back().name != name) {
            if (!result_.cells.empty()) end_cell();
            if (!seen_.insert(name).second)
                fail(line_, fmt::format("grain {} goes on behind other grains", name),
                     "the corners of a grain in rows one after the other");
            result_.cells.push_back({name, line_, {}});
        }
        result_.cells.back().corners.push_back(static_cast<int>(result_.vertices.size()));
        result_.vertices.push_back({number(fields[*x_]), number(fields[*y_])});
    }

    /// A polygon may be closed by its first corner.
    void end_cell() {
        std::vector<int>& corners = result_.cells.back().corners;
        const auto at = [&](int v) { return result_.vertices[v]; };
        if (corners.size() > 1 && at(corners.front()) == at(corners.back())) corners.pop_back();
    }

    std::string_view contents_;
    std::string file_;
    int line_ = 0;
    bool head_ = false;
    std::optional<std::size_t> grain_, x_, y_;
    std::set<std::string> others_, seen_;
    CellsOfFile result_;
};

}  // namespace

CellFormat cell_format_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".tess") return CellFormat::tess;
    if (ending == ".msh") return CellFormat::msh;
    if (ending == ".csv") return CellFormat::csv;
    throw InputError({file.string(), 0, 0, {}}, "is no file of cells by its name",
                     "a name that ends with .tess (Neper), .msh (gmsh) or .csv (grain,x,y)");
}

std::string read_cell_file(const std::filesystem::path& file) {
    const InputPlace place{file.string(), 0, 0, {}};
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) throw InputError(place, "is a directory, not a file of cells");
    const std::uintmax_t size = std::filesystem::file_size(file, ignored);
    if (!ignored && size > largest_file) throw InputError(place, "is larger than 1 GiB, which no file of cells is");
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InputError(place, std::string("cannot be read: ") + (errno != 0 ? std::strerror(errno) : "unknown reason"));
    std::string text;
    std::vector<char> buffer(std::size_t{1} << 20);
    while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || stream.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > largest_file) throw InputError(place, "is larger than 1 GiB, which no file of cells is");
    }
    if (stream.bad()) throw InputError(place, "cannot be read to its end");
    return text;
}

CellsOfFile read_cells(std::string_view contents, const std::filesystem::path& file) {
    const CellFormat format = cell_format_of(file);
    if (contents.empty()) throw InputError({file.string(), 0, 0, {}}, "is empty", "a file of cells");
    switch (format) {
        case CellFormat::tess:
            return TessReader(contents, file).read();
        case CellFormat::msh:
            return MshReader(contents, file).read();
        case CellFormat::csv:
            return CsvReader(contents, file).read();
    }
    return {};
}

}  // namespace feldspar
