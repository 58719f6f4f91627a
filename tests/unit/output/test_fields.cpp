// The files with fields, read back: HDF5 archive and VTU.
#include "feldspar/output/test_fields.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <zlib.h>

#include <cstring>
#include <vector>

#include "../../temporary_folder.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/output/crack_geometry.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/vtu_grid.hpp"
#include "synthetic_result.hpp"

namespace feldspar {
namespace {

using namespace testing;

class Fields : public ::testing::Test {
protected:
    TemporaryFolder scratch;
    RunDirectory directory = RunDirectory::create(scratch.path() / "run", "job");
    TestResult result = make_result();
};

/// A data set of doubles (HDF5 converts from what is stored).
std::vector<double> read_set(hid_t file, const std::string& name) {
    const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    if (!values.empty()) H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(set);
    return values;
}

std::string read_attribute(hid_t file, const std::string& object, const char* key) {
    const hid_t attribute = H5Aopen_by_name(file, object.c_str(), key, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    std::string text(H5Tget_size(type), '\0');
    H5Aread(attribute, type, text.data());
    H5Tclose(type);
    H5Aclose(attribute);
    return text.c_str();
}

TEST_F(Fields, ArchiveReadsBack) {
    write_hdf5(directory, result, make_job(), make_provenance());
    const hid_t file = H5Fopen((directory.path() / "uniaxial-compression-s3.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    for (const HistoryColumn& column : history_columns()) {
        const auto values = read_set(file, std::string("/history/") + column.name);
        ASSERT_EQ(values.size(), result.history.size());
        for (std::size_t r = 0; r < values.size(); ++r) EXPECT_EQ(values[r], column.value(result.history[r])) << column.name;
        EXPECT_EQ(read_attribute(file, std::string("/history/") + column.name, "unit"), column.unit);
    }
    EXPECT_EQ(read_set(file, "/cracks/mode"), (std::vector<double>{0.0, 1.0}));
    EXPECT_EQ(read_set(file, "/cracks/from").size(), 4U);
    EXPECT_EQ(read_set(file, "/mesh/nodes").size(), 2 * result.specimen->mesh.nodes.size());
    EXPECT_EQ(read_set(file, "/mesh/triangles").size(), 3 * result.specimen->mesh.triangles.size());
    EXPECT_EQ(read_set(file, "/mesh/grain")[5], 1.0);
    const Snapshot& snapshot = result.snapshots[1];
    EXPECT_FLOAT_EQ(static_cast<float>(read_set(file, "/snapshots/001-first-crack/stress_yy")[3]),
                    static_cast<float>(snapshot.stress_yy_Pa[3]));
    EXPECT_EQ(read_set(file, "/snapshots/001-first-crack/displacement")[13], snapshot.displacement_m[6].y);
    EXPECT_EQ(read_set(file, "/snapshots/001-first-crack/crack_opening"), snapshot.crack_opening_m);
    EXPECT_TRUE(read_set(file, "/snapshots/000-start/crack_opening").empty());
    EXPECT_EQ(read_attribute(file, "/snapshots/001-first-crack/displacement", "unit"), "m");
    EXPECT_EQ(read_attribute(file, "/", "version"), "0.1.0");
    EXPECT_NE(read_attribute(file, "/", "signs").find("compression positive"), std::string::npos);
    H5Fclose(file);
    EXPECT_EQ(count_entries(directory.path()), 1);
}

TEST_F(Fields, ArchiveOfTheSameResultsHasTheSameBytes) {
    write_hdf5(directory, result, make_job(), make_provenance());
    const std::string before = read_text(directory.path() / "uniaxial-compression-s3.h5");
    write_hdf5(directory, result, make_job(), make_provenance());
    EXPECT_EQ(read_text(directory.path() / "uniaxial-compression-s3.h5"), before);
}

TEST_F(Fields, NothingInAnArchiveSaysWhenItWasMade) {  // a second later the bytes would be others
    write_hdf5(directory, result, make_job(), make_provenance());
    const hid_t file = H5Fopen((directory.path() / "uniaxial-compression-s3.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    int objects = 0;
    H5Ovisit2(
        file, H5_INDEX_NAME, H5_ITER_NATIVE,
        [](hid_t, const char* name, const auto* info, void* count) -> herr_t {
            ++*static_cast<int*>(count);
            EXPECT_EQ(info->mtime, 0) << name;
            EXPECT_EQ(info->ctime, 0) << name;
            return 0;
        },
        &objects, H5O_INFO_TIME);
    EXPECT_GT(objects, 20);
    H5Fclose(file);
}

TEST_F(Fields, ArchiveOfATestWithoutAnythingIsWhole) {
    TestResult empty;
    empty.seed = 1;
    EXPECT_NO_THROW(write_hdf5(directory, empty, make_job(), make_provenance()));
    EXPECT_NO_THROW(write_paraview(directory, fields_of(empty)));
    EXPECT_NO_THROW(write_paraview(directory, read_archive(directory.path() / "uniaxial-compression-s1.h5")));
}

/// What VTK does to a compressed array.
std::string decompress(std::string_view bytes) {
    const auto number = [&](std::size_t index) {
        std::uint64_t value = 0;
        std::memcpy(&value, bytes.data() + 8 * index, 8);
        return value;
    };
    const std::uint64_t blocks = number(0);
    std::string data;
    std::size_t from = 8 * (3 + blocks);
    for (std::uint64_t b = 0; b < blocks; ++b) {
        uLongf size = b + 1 == blocks && number(2) > 0 ? number(2) : number(1);
        std::string block(size, '\0');
        EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size, reinterpret_cast<const Bytef*>(bytes.data() + from),
                             number(3 + b)),
                  Z_OK);
        data.append(block.data(), size);
        from += number(3 + b);
    }
    return data;
}

/// The value of the next XML attribute `name` from `from` on.
std::string value_of(const std::string& xml, const std::string& name, std::size_t from) {
    const std::size_t begin = xml.find(name + "=\"", from) + name.size() + 2;
    return xml.substr(begin, xml.find('"', begin) - begin);
}

template <class Number>
std::vector<Number> vtu_array(const std::string& file, const std::string& name) {
    const std::size_t head = file.find("<AppendedData");
    const std::size_t element = file.find("Name=\"" + name + "\"");
    if (element >= head) return {};
    const std::size_t offset = std::stoull(value_of(file, "offset", element));
    const std::string data = decompress(std::string_view(file).substr(file.find("\n_", head) + 2 + offset));
    std::vector<Number> values(data.size() / sizeof(Number));
    std::memcpy(values.data(), data.data(), data.size());
    return values;
}

TEST_F(Fields, ArchiveGivesBackWhatIsDrawn) {
    write_hdf5(directory, result, make_job(), make_provenance());
    const TestFields written = fields_of(result), read = read_archive(directory.path() / "uniaxial-compression-s3.h5");
    EXPECT_EQ(read.stem, written.stem);
    EXPECT_EQ(read.triangles, written.triangles);
    EXPECT_EQ(read.grain, written.grain);
    ASSERT_EQ(read.contacts.size(), written.contacts.size());
    EXPECT_EQ(read.contacts[1].grain_b, written.contacts[1].grain_b);
    EXPECT_EQ(read.contacts[1].to.y, written.contacts[1].to.y);
    ASSERT_EQ(read.cracks.size(), 2U);
    EXPECT_EQ(read.cracks[1].mode, CrackMode::shear);
    ASSERT_EQ(read.snapshots.size(), written.snapshots.size());
    for (std::size_t n = 0; n < read.snapshots.size(); ++n) {
        EXPECT_EQ(read.snapshots[n].label, written.snapshots[n].label);
        EXPECT_EQ(read.snapshots[n].step, written.snapshots[n].step);
        EXPECT_EQ(read.snapshots[n].cracks, written.snapshots[n].cracks);
        EXPECT_EQ(read.snapshots[n].damage, written.snapshots[n].damage);
        EXPECT_EQ(read.snapshots[n].contact_normal_N, written.snapshots[n].contact_normal_N);
        ASSERT_EQ(read.snapshots[n].displacement_m.size(), written.snapshots[n].displacement_m.size());
        EXPECT_EQ(read.snapshots[n].displacement_m[6].y, written.snapshots[n].displacement_m[6].y);
    }
    EXPECT_EQ(read.events.size(), written.events.size());
}

// The files for ParaView are the same whether they are made of the result or of its archive.
TEST_F(Fields, ExportOfAnArchiveHasTheBytesOfTheResult) {
    write_hdf5(directory, result, make_job(), make_provenance());
    const RunDirectory one = RunDirectory::create(scratch.path() / "one", "job"),
                       other = RunDirectory::create(scratch.path() / "other", "job");
    write_paraview(one, fields_of(result));
    write_paraview(other, read_archive(directory.path() / "uniaxial-compression-s3.h5"), 2);
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(one.path())) {
        if (!entry.is_regular_file() || entry.path().extension() == ".py") continue;  // which names its directory
        const auto twin = other.path() / std::filesystem::relative(entry.path(), one.path());
        EXPECT_EQ(read_text(entry.path()), read_text(twin)) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 1 + 3 * 6);  // the collection; of each snapshot five blocks and their list
}

TEST_F(Fields, WhatIsNoArchiveIsRefused) {
    directory.write_text("text.h5", "no archive");
    EXPECT_THROW((void)read_archive(directory.path() / "text.h5"), InputError);
    EXPECT_THROW((void)read_archive(directory.path() / "missing.h5"), InputError);
    write_hdf5(directory, result, make_job(), make_provenance());
    const std::string file = (directory.path() / "uniaxial-compression-s3.h5").string();
    {
        const hid_t archive = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t version = H5Aopen_by_name(archive, "/", "format_version", H5P_DEFAULT, H5P_DEFAULT);
        const int later = 99;
        H5Awrite(version, H5T_NATIVE_INT, &later);
        H5Aclose(version);
        H5Fclose(archive);
    }
    try {
        (void)read_archive(file);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("version 99"), std::string::npos) << error.what();
    }
    const std::string whole = read_text(file);
    for (const std::size_t length : {whole.size() / 4, whole.size() / 2,
                                     whole.size() - 200}) {  // a file that was cut is refused, or read as far as it is whole
        directory.write_text("cut.h5", whole.substr(0, length));
        try {
            (void)read_archive(directory.path() / "cut.h5");
        } catch (const InputError&) {
        }
    }
}

TEST_F(Fields, VtuReadsBack) {
    write_paraview(directory, fields_of(result));
    const auto folder = directory.path() / "uniaxial-compression-s3";
    const std::string grains = read_text(folder / "grains-001.vtu");
    const GrainMesh& mesh = result.specimen->mesh;
    const Snapshot& snapshot = result.snapshots[1];
    const auto points = vtu_array<double>(grains, "Points");
    ASSERT_EQ(points.size(), 3 * mesh.nodes.size());
    EXPECT_EQ(points[3 * 7 + 1], mesh.nodes[7].y);
    const auto corners = vtu_array<std::int32_t>(grains, "connectivity");
    ASSERT_EQ(corners.size(), 3 * mesh.triangles.size());
    EXPECT_EQ(corners[3 * 5 + 2], mesh.triangles[5][2]);
    EXPECT_EQ(vtu_array<std::int64_t>(grains, "offsets").back(), static_cast<std::int64_t>(corners.size()));
    EXPECT_EQ(vtu_array<std::uint8_t>(grains, "types").front(), 5);
    EXPECT_EQ(vtu_array<float>(grains, "damage"), snapshot.damage);
    EXPECT_FLOAT_EQ(vtu_array<float>(grains, "stress_yy_MPa")[3], static_cast<float>(snapshot.stress_yy_Pa[3] * 1e-6));
    EXPECT_FLOAT_EQ(vtu_array<float>(grains, "displacement_m")[3 * 6], static_cast<float>(snapshot.displacement_m[6].x));
    EXPECT_EQ(vtu_array<std::int32_t>(grains, "grain")[4], 1);
    const float major = vtu_array<float>(grains, "sigma_1_MPa")[3];
    EXPECT_GE(major, vtu_array<float>(grains, "sigma_3_MPa")[3]);
    EXPECT_GE(major, static_cast<float>(snapshot.stress_yy_Pa[3] * 1e-6));

    const std::string cracks = read_text(folder / "cracks-002.vtu");
    EXPECT_EQ(vtu_array<std::int32_t>(cracks, "mode"), (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(vtu_array<std::int64_t>(cracks, "step"), (std::vector<std::int64_t>{550, 800}));
    EXPECT_EQ(vtu_array<float>(cracks, "opening_m").size(), 2U);
    EXPECT_FLOAT_EQ(vtu_array<float>(cracks, "time")[0], static_cast<float>(result.cracks[0].axial_strain));
    EXPECT_EQ(vtu_array<std::uint8_t>(cracks, "types").front(), 3);
    // the line of the first crack lies midway between the faces of grains 0 and 1, which are 1 um apart
    const auto moved = vtu_array<float>(cracks, "displacement_m");
    const auto faces = find_crack_faces(*result.specimen, result.cracks);
    const auto a = face_displacement(faces[0].a, result.snapshots[2].displacement_m),
               b = face_displacement(faces[0].b, result.snapshots[2].displacement_m);
    EXPECT_FLOAT_EQ(moved[0], static_cast<float>(0.5 * (a[0].x + b[0].x)));
    EXPECT_FLOAT_EQ(moved[4], static_cast<float>(0.5 * (a[1].y + b[1].y)));
}

TEST_F(Fields, ContactsThatAreNotBrokenHaveDamageAndForce) {
    write_paraview(directory, fields_of(result));
    const auto folder = directory.path() / "uniaxial-compression-s3";
    const std::size_t contacts = result.grain_contacts.size();
    EXPECT_EQ(vtu_array<float>(read_text(folder / "contacts-000.vtu"), "damage").size(), contacts);
    const std::string end = read_text(folder / "contacts-002.vtu");
    const auto damage = vtu_array<float>(end, "damage");
    ASSERT_EQ(damage.size(), contacts - 2);  // two cracks broke one each
    for (const float one : damage) EXPECT_LT(one, 1.0F);
    EXPECT_EQ(vtu_array<float>(end, "normal_force_N").size(), damage.size());
    EXPECT_EQ(vtu_array<float>(end, "shear_force_N").size(), damage.size());
    EXPECT_EQ(vtu_array<std::int32_t>(end, "grain_a").size(), damage.size());
}

TEST_F(Fields, EdgesOfGrainsAreThoseOfTheirCells) {
    write_paraview(directory, fields_of(result));
    const std::string edges = read_text(directory.path() / "uniaxial-compression-s3/grain_edges-000.vtu");
    const auto ends = vtu_array<std::int32_t>(edges, "connectivity");
    ASSERT_EQ(ends.size(), 2 * 4 * result.specimen->cells.cells.size());
    for (const std::int32_t node : ends)
        EXPECT_NE(node % 5, 4) << "the node in the middle";  // each grain has four corners, then that
}

TEST_F(Fields, CollectionNamesEveryBlockAtGrowingTimes) {
    write_paraview(directory, fields_of(result));
    const std::string collection = read_text(directory.path() / "uniaxial-compression-s3.pvd");
    double before = -1.0;
    int entries = 0, blocks = 0;
    for (std::size_t at = collection.find("<DataSet"); at != std::string::npos;
         at = collection.find("<DataSet", at + 1), ++entries) {
        const auto file = directory.path() / value_of(collection, "file", at);
        ASSERT_TRUE(std::filesystem::exists(file)) << file;
        const double time = std::stod(value_of(collection, "timestep", at));
        EXPECT_GT(time, before);
        before = time;
        const std::string list = read_text(file);
        std::vector<std::string> names;
        for (std::size_t block = list.find("<DataSet"); block != std::string::npos;
             block = list.find("<DataSet", block + 1), ++blocks) {
            names.push_back(value_of(list, "name", block));
            EXPECT_TRUE(std::filesystem::exists(file.parent_path() / value_of(list, "file", block))) << list;
        }
        EXPECT_EQ(names, (std::vector<std::string>{"grains", "grain_edges", "contacts", "cracks", "events"}));
    }
    EXPECT_EQ(entries, 3);
    EXPECT_EQ(blocks, 15);
    const std::string script = read_text(directory.path() / "uniaxial-compression-s3.py");
    EXPECT_EQ(script.find("{{"), std::string::npos);
    EXPECT_NE(script.find("STEM = \"uniaxial-compression-s3\""), std::string::npos);
}

TEST_F(Fields, WhatAnEarlierExportLeftBeyondIsRemoved) {
    write_paraview(directory, fields_of(result));
    result.snapshots.pop_back();
    write_paraview(directory, fields_of(result));
    const auto folder = directory.path() / "uniaxial-compression-s3";
    EXPECT_TRUE(std::filesystem::exists(folder / "grains-001.vtu"));
    for (const char* file :
         {"grains-002.vtu", "grain_edges-002.vtu", "contacts-002.vtu", "cracks-002.vtu", "events-002.vtu", "snapshot-002.vtm"})
        EXPECT_FALSE(std::filesystem::exists(folder / file)) << file;
}

TEST_F(Fields, TimesThatDoNotGrowBecomeNumbers) {
    result.snapshots[2].axial_strain = result.snapshots[1].axial_strain;
    write_paraview(directory, fields_of(result));
    const std::string collection = read_text(directory.path() / "uniaxial-compression-s3.pvd");
    EXPECT_NE(collection.find("timestep=\"2\""), std::string::npos);
    EXPECT_NE(collection.find("timestep = number of the snapshot"), std::string::npos);
}

TEST(VtkCompressed, HoldsAnyLength) {
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{1}, std::size_t{1} << 20, (std::size_t{1} << 20) + 5, std::size_t{3} << 20}) {
        std::string bytes(length, '\0');
        for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * i % 251);
        EXPECT_EQ(decompress(vtk_compressed(bytes)), bytes) << length;
        EXPECT_EQ(decompress(vtk_compressed(bytes, Repeats::not_searched)), bytes) << length;
    }
}

TEST(CrackGeometry, FacesMoveWithTheirOwnGrain) {
    const TestResult result = make_result();
    const auto faces = find_crack_faces(*result.specimen, result.cracks);
    ASSERT_EQ(faces.size(), 2U);
    const auto a = face_displacement(faces[0].a, result.snapshots[1].displacement_m);
    const auto b = face_displacement(faces[0].b, result.snapshots[1].displacement_m);
    EXPECT_NEAR(b[0].x - a[0].x, 1e-6, 1e-15);
    EXPECT_NEAR(b[1].x - a[1].x, 1e-6, 1e-15);
    EXPECT_NEAR(a[0].y, -result.snapshots[1].axial_strain * 0.25e-3, 1e-15);  // a quarter of the way up the edge
    EXPECT_NEAR(b[1].y, -result.snapshots[1].axial_strain * 0.75e-3, 1e-15);
}

TEST(CrackGeometry, AnUnknownNeighbourDoesNotMove) {
    TestResult result = make_result();
    result.cracks[0].grain_b = -1;
    const auto faces = find_crack_faces(*result.specimen, result.cracks);
    EXPECT_EQ(faces[0].b.node_0, -1);
    EXPECT_EQ(face_displacement(faces[0].b, result.snapshots[1].displacement_m)[0].x, 0.0);
}

}  // namespace
}  // namespace feldspar
