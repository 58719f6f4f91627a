// An archive of a test, read again: what it holds for programs that draw.
#include <fmt/format.h>

#include <algorithm>

#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/hdf5_handles.hpp"
#include "feldspar/output/test_fields.hpp"

namespace feldspar {

namespace {

bool there(hid_t place, const std::string& name) { return H5Lexists(place, name.c_str(), H5P_DEFAULT) > 0; }

template <class Number>
std::vector<Number> numbers(hid_t place, const std::string& name) {
    const Handle set(H5Dopen2(place, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(set), H5Sclose);
    std::vector<Number> values(static_cast<std::size_t>(require(H5Sget_simple_extent_npoints(space))));
    if (!values.empty()) require(H5Dread(set, type_of<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return values;
}

template <class Number>
Number number(hid_t object, const char* key) {
    const Handle attribute(H5Aopen(object, key, H5P_DEFAULT), H5Aclose);
    Number value{};
    require(H5Aread(attribute, type_of<Number>(), &value));
    return value;
}

std::string text(hid_t object, const char* key) {
    const Handle attribute(H5Aopen(object, key, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    std::string value(H5Tget_size(type) + 1, '\0');
    require(H5Aread(attribute, type, value.data()));
    return value.c_str();
}

std::vector<Vec2> points(hid_t place, const std::string& name) {
    const std::vector<double> flat = numbers<double>(place, name);
    std::vector<Vec2> list;
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2) list.push_back({flat[i], flat[i + 1]});
    return list;
}

/// @throws OutputError if a list has another length than belongs to it: caught below
void require_length(std::size_t found, std::size_t wanted, const char* what) {
    if (found != wanted) throw OutputError(fmt::format("{} values of {} instead of {}", found, what, wanted));
}

void require_below(const std::vector<int>& values, std::size_t end, const char* what) {
    for (const int value : values)
        if (value < 0 || static_cast<std::size_t>(value) >= end)
            throw OutputError(fmt::format("{} {} does not exist", what, value));
}

void read_mesh(hid_t root, TestFields& fields) {
    if (!there(root, "mesh")) return;
    const Handle group(H5Gopen2(root, "mesh", H5P_DEFAULT), H5Gclose);
    fields.nodes = points(group, "nodes");
    const std::vector<int> corners = numbers<int>(group, "triangles");
    require_below(corners, fields.nodes.size(), "node");
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        fields.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    fields.grain = numbers<int>(group, "grain");
    require_length(fields.grain.size(), fields.triangles.size(), "grain");
    require_below(fields.grain, fields.triangles.size(), "grain");
    if (!there(group, "mineral")) return;
    fields.mineral = numbers<int>(group, "mineral");
    require_below(fields.grain, fields.mineral.size(), "grain");
}

void read_contacts(hid_t root, TestFields& fields) {
    if (!there(root, "contacts")) return;  // of version 1
    const Handle group(H5Gopen2(root, "contacts", H5P_DEFAULT), H5Gclose);
    const std::vector<int> a = numbers<int>(group, "grain_a"), b = numbers<int>(group, "grain_b");
    const std::vector<Vec2> from = points(group, "from"), to = points(group, "to");
    for (const std::size_t length : {b.size(), from.size(), to.size()}) require_length(length, a.size(), "contacts");
    for (std::size_t c = 0; c < a.size(); ++c) fields.contacts.push_back({a[c], b[c], from[c], to[c]});
}

void read_cracks(hid_t root, TestFields& fields) {
    const Handle group(H5Gopen2(root, "cracks", H5P_DEFAULT), H5Gclose);
    const auto step = numbers<std::int64_t>(group, "step");
    const auto strain = numbers<double>(group, "axial_strain"), stress = numbers<double>(group, "axial_stress"),
               energy = numbers<double>(group, "energy");
    const auto mode = numbers<int>(group, "mode"), a = numbers<int>(group, "grain_a"), b = numbers<int>(group, "grain_b");
    const auto place = points(group, "place"), from = points(group, "from"), to = points(group, "to");
    for (const std::size_t length :
         {strain.size(), stress.size(), energy.size(), mode.size(), a.size(), b.size(), place.size(), from.size(), to.size()})
        require_length(length, step.size(), "cracks");
    for (std::size_t c = 0; c < step.size(); ++c) {
        Crack crack;
        crack.step = step[c];
        crack.axial_strain = strain[c];
        crack.axial_stress_Pa = stress[c];
        crack.mode = mode[c] == 0 ? CrackMode::tensile : CrackMode::shear;
        crack.grain_a = a[c];
        crack.grain_b = b[c];
        crack.place = place[c];
        crack.from = from[c];
        crack.to = to[c];
        crack.energy_J = energy[c];
        fields.cracks.push_back(crack);
    }
}

void read_events(hid_t root, TestFields& fields) {
    if (!there(root, "events")) return;
    const Handle group(H5Gopen2(root, "events", H5P_DEFAULT), H5Gclose);
    for (const EventColumn& column : event_columns())
        if (there(group, column.name)) fields.events.push_back({column.name, numbers<double>(group, column.name)});
    for (const EventValues& column : fields.events)
        require_length(column.values.size(), fields.events.front().values.size(), "events");
}

Snapshot read_snapshot(hid_t group, const TestFields& fields) {
    Snapshot snapshot;
    const std::size_t nodes = fields.nodes.size(), triangles = fields.triangles.size(), contacts = fields.contacts.size();
    snapshot.label = text(group, "label");
    snapshot.step = number<std::int64_t>(group, "step");
    snapshot.axial_strain = number<double>(group, "axial_strain");
    snapshot.axial_stress_Pa = number<double>(group, "axial_stress_MPa") * 1e6;
    snapshot.cracks = number<int>(group, "cracks");
    snapshot.displacement_m = points(group, "displacement");
    require_length(snapshot.displacement_m.size(), nodes, "displacement");
    const auto of_triangles = [&](const char* name, std::vector<double>& values) {
        values = numbers<double>(group, name);
        require_length(values.size(), triangles, name);
    };
    of_triangles("stress_xx", snapshot.stress_xx_Pa);
    of_triangles("stress_yy", snapshot.stress_yy_Pa);
    of_triangles("stress_xy", snapshot.stress_xy_Pa);
    snapshot.damage = numbers<float>(group, "damage");
    require_length(snapshot.damage.size(), triangles, "damage");
    snapshot.crack_opening_m = numbers<double>(group, "crack_opening");
    const auto of_contacts = [&](const char* name, std::vector<float>& values) {
        if (there(group, name)) values = numbers<float>(group, name);
        if (!values.empty()) require_length(values.size(), contacts, name);
    };
    of_contacts("contact_damage", snapshot.contact_damage);
    of_contacts("contact_normal_force", snapshot.contact_normal_N);
    of_contacts("contact_shear_force", snapshot.contact_shear_N);
    require_length(snapshot.contact_normal_N.size(), snapshot.contact_damage.size(), "contact forces");
    require_length(snapshot.contact_shear_N.size(), snapshot.contact_damage.size(), "contact forces");
    return snapshot;
}

void read_snapshots(hid_t root, TestFields& fields) {
    const Handle all(H5Gopen2(root, "snapshots", H5P_DEFAULT), H5Gclose);
    std::vector<std::string> names;
    require(H5Literate(
        all, H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
            static_cast<std::vector<std::string>*>(into)->emplace_back(name);
            return 0;
        },
        &names));
    for (const std::string& name : names) {
        const Handle group(H5Gopen2(all, name.c_str(), H5P_DEFAULT), H5Gclose);
        fields.snapshots.push_back(read_snapshot(group, fields));
    }
    std::ranges::stable_sort(fields.snapshots, {}, &Snapshot::step);  // names have three digits
}

}  // namespace

TestFields read_archive(const std::filesystem::path& file) {
    const std::lock_guard alone(hdf5_mutex());
    hdf5_closes_nothing();
    const Silence silence;
    const InputPlace place{.file = file.string()};
    TestFields fields;
    fields.stem = file.stem().string();
    int version = 1;
    try {
        const Handle archive(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
        const Handle root(H5Gopen2(archive, "/", H5P_DEFAULT), H5Gclose);
        if (H5Aexists(root, "format_version") > 0) version = number<int>(root, "format_version");
        if (version <= archive_version) {
            read_mesh(root, fields);
            read_contacts(root, fields);
            read_cracks(root, fields);
            read_events(root, fields);
            read_snapshots(root, fields);
        }
    } catch (const OutputError& problem) {
        throw InputError(place, fmt::format("cannot be read as the archive of a test: {}", problem.what()),
                         "a .h5 file that 'feldspar run' has written");
    }
    if (version > archive_version)
        throw InputError(place,
                         fmt::format("has version {} of the format, which a later version of this program has written", version),
                         fmt::format("versions 1 to {}", archive_version));
    return fields;
}

}  // namespace feldspar
