// A test as an HDF5 archive: history, cracks, mesh, fields at the snapshots, provenance.
//
// The file is built in memory (the library's core driver) and handed to the run directory as bytes. Writing straight to disk
// was rejected: after a failed flush HDF5 1.10 keeps the file open and complains again when the program ends.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/hdf5_handles.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

Handle make_group(hid_t parent, const std::string& name) {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
}

void set_text(hid_t object, const char* key, const std::string& value) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type, value.size() + 1));
    require(H5Tset_cset(type, H5T_CSET_UTF8));
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, key, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(H5Awrite(attribute, type, value.c_str()));
}

template <class Number>
void set_number(hid_t object, const char* key, Number value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, key, type_of<Number>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(H5Awrite(attribute, type_of<Number>(), &value));
}

/// Settings of a data set that does not say when it was made: the same results give the same bytes.
Handle timeless() {
    const hid_t settings = require(H5Pcreate(H5P_DATASET_CREATE));
    require(H5Pset_obj_track_times(settings, false));
    return {settings, H5Pclose};
}

/// Writes `values` as rows of `width` numbers, shuffled and compressed, with its unit and meaning as attributes.
template <class Number>
void put(hid_t parent, const std::string& name, const std::vector<Number>& values, hsize_t width, const char* unit,
         const char* meaning) {
    const hsize_t rows = values.size() / width;
    const hsize_t extent[2] = {rows, width};
    const int rank = width == 1 ? 1 : 2;
    const Handle space(H5Screate_simple(rank, extent, nullptr), H5Sclose);
    const Handle settings = timeless();
    if (rows > 0) {
        const hsize_t chunk[2] = {std::min<hsize_t>(rows, 65536), width};
        require(H5Pset_chunk(settings, rank, chunk));
        require(H5Pset_shuffle(settings));
        require(H5Pset_deflate(settings, 1));  // level 5 makes archives 1 % smaller and takes a tenth longer
    }
    const Handle set(H5Dcreate2(parent, name.c_str(), type_of<Number>(), space, H5P_DEFAULT, settings, H5P_DEFAULT), H5Dclose);
    if (rows > 0) require(H5Dwrite(set, type_of<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    set_text(set, "unit", unit);
    set_text(set, "meaning", meaning);
}

std::vector<double> flat(const std::vector<Vec2>& points) {
    std::vector<double> numbers;
    numbers.reserve(2 * points.size());
    for (const Vec2 point : points) numbers.insert(numbers.end(), {point.x, point.y});
    return numbers;
}

/// Seven digits are enough for a stress, and fields are most of a file. Displacements keep all: openings are differences.
std::vector<float> floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

/// One number of each crack.
template <class Number, class Pick>
std::vector<Number> each(const std::vector<Crack>& cracks, Pick pick) {
    std::vector<Number> numbers;
    numbers.reserve(cracks.size());
    for (const Crack& crack : cracks) numbers.push_back(static_cast<Number>(pick(crack)));
    return numbers;
}

void put_provenance(hid_t root, const TestResult& result, const Job& job, const Provenance& provenance) {
    set_text(root, "format", "feldspar archive of a test");
    set_number(root, "format_version", archive_version);
    set_text(root, "program", "feldspar");
    set_text(root, "version", provenance.version);
    set_text(root, "commit", provenance.commit);
    set_text(root, "machine", provenance.machine);
    set_text(root, "compiler", provenance.compiler);
    set_text(root, "started", provenance.started);
    set_text(root, "command_line", provenance.command_line);
    if (!provenance.device.empty()) set_text(root, "device", provenance.device);
    set_number(root, "threads", provenance.threads);
    set_text(root, "job_name", job.name);
    set_text(root, "signs", sign_convention);
    if (!result.variant.empty()) set_text(root, "variant", result.variant);
    set_text(root, "kind", name(result.test.kind));
    if (!result.test.custom.name.empty()) set_text(root, "name", result.test.custom.name);
    set_number(root, "seed", static_cast<std::int64_t>(result.seed));
    set_number(root, "sigma3_MPa", result.test.sigma3_Pa * MPa);
    set_text(root, "model", name(result.model.kind));
    set_text(root, "contact", name(result.model.contact));
    set_text(root, "law", name(result.contact.law));
    set_text(root, "numerics", name(result.numerics.kind));
    set_text(root, "plane", name(result.model.plane));
    set_text(root, "stop_reason", result.stop_reason);
    set_text(root, "quasi_static", std::string(1, result.evidence.grade));
    set_text(root, "verdict", result.evidence.verdict);
    // an attribute holds at most 64 kB: the job is a data set of characters
    const std::string resolved = resolved_toml(job);
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type, resolved.size() + 1));
    require(H5Tset_cset(type, H5T_CSET_UTF8));
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle set(H5Dcreate2(root, "job", type, space, H5P_DEFAULT, timeless(), H5P_DEFAULT), H5Dclose);
    require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, resolved.c_str()));
    set_text(set, "meaning", "the job with every default written out, as TOML");
}

void put_history(hid_t root, const TestResult& result) {
    const Handle group = make_group(root, "history");
    for (const FileColumn& column : history_columns(result)) {
        std::vector<double> values;
        values.reserve(result.history.size());
        for (const HistoryRow& row : result.history) values.push_back(column.value(row));
        if (column.whole) {
            put(group, column.name.c_str(), std::vector<std::int64_t>(values.begin(), values.end()), 1, column.unit.c_str(),
                column.meaning.c_str());
        } else {
            put(group, column.name.c_str(), values, 1, column.unit.c_str(), column.meaning.c_str());
        }
    }
}

void put_cracks(hid_t root, const std::vector<Crack>& cracks) {
    const Handle group = make_group(root, "cracks");
    const auto points = [&](auto pick) {
        std::vector<Vec2> list;
        list.reserve(cracks.size());
        for (const Crack& crack : cracks) list.push_back(pick(crack));
        return flat(list);
    };
    put(group, "step", each<std::int64_t>(cracks, [](const Crack& c) { return c.step; }), 1, "1", "loading step of the break");
    put(group, "axial_strain", each<double>(cracks, [](const Crack& c) { return c.axial_strain; }), 1, "1",
        "from the platens, at the break");
    put(group, "axial_stress", each<double>(cracks, [](const Crack& c) { return c.axial_stress_Pa; }), 1, "Pa", "at the break");
    put(group, "mode", each<int>(cracks, [](const Crack& c) { return static_cast<int>(c.mode); }), 1, "1", "0 tensile, 1 shear");
    put(group, "grain_a", each<int>(cracks, [](const Crack& c) { return c.grain_a; }), 1, "1", "grain on one side");
    put(group, "grain_b", each<int>(cracks, [](const Crack& c) { return c.grain_b; }), 1, "1", "grain on the other side");
    put(group, "contact", each<int>(cracks, [](const Crack& c) { return c.contact; }), 1, "1", "contact of the initial assembly");
    put(group, "point", each<int>(cracks, [](const Crack& c) { return c.point; }), 1, "1", "contact point within the contact");
    put(group, "place", points([](const Crack& c) { return c.place; }), 2, "m", "the contact point, undeformed");
    put(group, "from", points([](const Crack& c) { return c.from; }), 2, "m",
        "start of the point's share of the edge, undeformed");
    put(group, "to", points([](const Crack& c) { return c.to; }), 2, "m", "its end");
    put(group, "area", each<double>(cracks, [](const Crack& c) { return c.area_m2; }), 1, "m2", "area of the contact point");
    put(group, "energy", each<double>(cracks, [](const Crack& c) { return c.energy_J; }), 1, "J", "dissipated until the break");
    put(group, "normal", points([](const Crack& c) { return c.normal; }), 2, "1",
        "from grain_a to grain_b, when it was recorded");
    put(group, "opening", each<double>(cracks, [](const Crack& c) { return c.opening_m; }), 1, "m",
        "along the normal, when it was recorded");
    put(group, "slip", each<double>(cracks, [](const Crack& c) { return c.slip_m; }), 1, "m",
        "of grain_b across the normal (a quarter turn to the left), when it was recorded");
}

void put_events(hid_t root, const TestResult& result) {
    const AcousticEmission& emission = result.emission;
    if (emission.events.empty()) return;
    const Handle group = make_group(root, "events");
    for (const EventColumn& column : event_columns()) {
        std::vector<double> values;
        for (const AcousticEvent& event : emission.events) values.push_back(column.value(event));
        if (column.whole)
            put(group, column.name, std::vector<std::int64_t>(values.begin(), values.end()), 1, column.unit, column.meaning);
        else
            put(group, column.name, values, 1, column.unit, column.meaning);
    }
}

void put_mesh(hid_t root, const GrainMesh& mesh, const std::vector<int>& phase_of_grain) {
    const Handle group = make_group(root, "mesh");
    std::vector<int> triangles;
    std::vector<int> grain(mesh.triangles.size(), 0);
    for (const auto& triangle : mesh.triangles) triangles.insert(triangles.end(), triangle.begin(), triangle.end());
    for (std::size_t g = 0; g + 1 < mesh.triangle_begin.size(); ++g) {
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t)
            grain[static_cast<std::size_t>(t)] = static_cast<int>(g);
    }
    put(group, "nodes", flat(mesh.nodes), 2, "m", "undeformed position of each node");
    put(group, "triangles", triangles, 3, "1", "three nodes each, counter-clockwise");
    put(group, "grain", grain, 1, "1", "grain of each triangle");
    if (!phase_of_grain.empty())
        put(group, "mineral", phase_of_grain, 1, "1", "of each grain, in the order of [[material.phase]]");
}

void put_contacts(hid_t root, const std::vector<ContactPlace>& contacts) {
    const Handle group = make_group(root, "contacts");
    const auto grains = [&](int ContactPlace::*grain) {
        std::vector<int> list;
        list.reserve(contacts.size());
        for (const ContactPlace& contact : contacts) list.push_back(contact.*grain);
        return list;
    };
    const auto ends = [&](Vec2 ContactPlace::*end) {
        std::vector<Vec2> list;
        list.reserve(contacts.size());
        for (const ContactPlace& contact : contacts) list.push_back(contact.*end);
        return flat(list);
    };
    put(group, "grain_a", grains(&ContactPlace::grain_a), 1, "1", "grain on one side");
    put(group, "grain_b", grains(&ContactPlace::grain_b), 1, "1", "grain on the other side");
    put(group, "from", ends(&ContactPlace::from), 2, "m", "start of the contact's share of the edge, undeformed");
    put(group, "to", ends(&ContactPlace::to), 2, "m", "its end");
}

void put_snapshots(hid_t root, const std::vector<Snapshot>& snapshots) {
    const Handle all = make_group(root, "snapshots");
    for (std::size_t n = 0; n < snapshots.size(); ++n) {
        const Snapshot& snapshot = snapshots[n];
        const Handle group = make_group(all, fmt::format("{:03}-{}", n, snapshot.label));
        set_text(group, "label", snapshot.label);
        set_number(group, "step", static_cast<std::int64_t>(snapshot.step));
        set_number(group, "axial_strain", snapshot.axial_strain);
        set_number(group, "axial_stress_MPa", snapshot.axial_stress_Pa * MPa);
        set_number(group, "cracks", snapshot.cracks);
        put(group, "displacement", flat(snapshot.displacement_m), 2, "m", "of each node");
        put(group, "stress_xx", floats(snapshot.stress_xx_Pa), 1, "Pa", "Cauchy, each triangle, compression positive");
        put(group, "stress_yy", floats(snapshot.stress_yy_Pa), 1, "Pa", "Cauchy, each triangle, compression positive");
        put(group, "stress_xy", floats(snapshot.stress_xy_Pa), 1, "Pa", "Cauchy, each triangle, compression positive");
        put(group, "damage", snapshot.damage, 1, "1", "largest damage on the grain edge of each triangle, 0 intact, 1 broken");
        put(group, "crack_opening", snapshot.crack_opening_m, 1, "m",
            "of the first cracks of /cracks, in their order; positive is open");
        put(group, "contact_damage", snapshot.contact_damage, 1, "1",
            "of each of /contacts, 0 intact, 1 broken: the largest of its points");
        put(group, "contact_normal_force", snapshot.contact_normal_N, 1, "N", "of each of /contacts, compression positive");
        put(group, "contact_shear_force", snapshot.contact_shear_N, 1, "N",
            "of each of /contacts: on grain_b, along the normal turned by a quarter to the left");
    }
}

/// HDF5 1.10 can leave the heap in disorder when memory ends in one of its calls, so what the archive will need is asked for
/// before.
/// @throws std::bad_alloc
void require_memory(const TestResult& result) {
    std::size_t numbers = 64 * result.history.size() + 16 * result.cracks.size();
    for (const Snapshot& snapshot : result.snapshots)
        numbers += 2 * snapshot.displacement_m.size() + 4 * snapshot.stress_xx_Pa.size() + snapshot.crack_opening_m.size() +
                   2 * snapshot.contact_damage.size();
    if (result.specimen) numbers += 2 * result.specimen->mesh.nodes.size() + 4 * result.specimen->mesh.triangles.size();
    const std::size_t bytes =
        3 * numbers * sizeof(double) + (std::size_t{24} << 20);  // the file as it grows, its copy, and what the library keeps
    ::operator delete(::operator new(bytes));  // called by name: a new-expression might be left out by the compiler
}

std::string archive_bytes(const TestResult& result, const Job& job, const Provenance& provenance) {
    const Silence silence;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(H5Pset_fapl_core(access, 4 << 20, false));  // grows by 4 MiB; nothing reaches the disk
    const Handle file(H5Fcreate("archive-in-memory", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    {
        const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
        put_provenance(root, result, job, provenance);
        put_history(root, result);
        put_cracks(root, result.cracks);
        put_events(root, result);
        if (result.specimen) put_mesh(root, result.specimen->mesh, result.texture.phase_of_grain);
        put_contacts(root, result.grain_contacts);
        put_snapshots(root, result.snapshots);
    }
    require(H5Fflush(file, H5F_SCOPE_LOCAL));
    const ssize_t size = require(H5Fget_file_image(file, nullptr, 0));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    require(H5Fget_file_image(file, bytes.data(), bytes.size()));
    return bytes;
}

}  // namespace

std::mutex& hdf5_mutex() {
    static std::mutex mutex;
    return mutex;
}

void hdf5_closes_nothing() {
    static const bool done = H5dont_atexit() >= 0;
    (void)done;
}

void write_hdf5(const RunDirectory& directory, const TestResult& result, const Job& job, const Provenance& provenance) {
    const std::string file = test_stem(result) + ".h5";
    std::string bytes;
    const std::lock_guard alone(hdf5_mutex());
    hdf5_closes_nothing();
    require_memory(result);
    try {
        bytes = archive_bytes(result, job, provenance);
    } catch (const OutputError& problem) {
        throw OutputError(fmt::format("cannot write '{}': {}", (directory.path() / file).string(), problem.what()));
    }
    directory.write_text(file, bytes);
}

}  // namespace feldspar
