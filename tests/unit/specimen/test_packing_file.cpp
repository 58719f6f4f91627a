// A packing on disk: the same bits back, and every kind of damage found with its line.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "feldspar/base/error.hpp"
#include "feldspar/specimen/grain_sizes.hpp"
#include "feldspar/specimen/outline.hpp"
#include "sample_specimens.hpp"

namespace feldspar {
namespace {

class PackingFile : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        file_ = std::filesystem::temp_directory_path() / (std::string("feldspar_packing_") + info->name() + ".txt");
    }
    void TearDown() override { std::filesystem::remove(file_); }

    std::string text() const {
        std::ifstream stream(file_);
        std::ostringstream text;
        text << stream.rdbuf();
        return text.str();
    }
    void write(const std::string& text) const { std::ofstream(file_) << text; }

    /// The line that the error names; 0 if there was none or it was another error.
    int line_of_error(const Outline& outline) const {
        try {
            load_packing(file_, outline);
        } catch (const InputError& error) {
            EXPECT_EQ(error.place().file, file_.string());
            return error.place().line;
        }
        return 0;
    }

    std::filesystem::path file_;
};

TEST_F(PackingFile, OfAFlattenedDiscFitsNoOtherDisc) {
    save_packing(make_specimen(flattened_disc(0.03), 1), file_);
    EXPECT_EQ(line_of_error(make_outline(flattened_disc(0.03).outline)), 0);
    EXPECT_EQ(line_of_error(make_outline(flattened_disc(0.03, 25.0).outline)), 3);
    EXPECT_EQ(line_of_error(make_outline(disc(0.03).outline)), 3);
}

TEST_F(PackingFile, ComesBackWithTheSameBits) {
    for (const SpecimenSpec& spec : {rectangle(0.03, 0.03), disc(0.03), flattened_disc(0.03), ell()}) {
        const Specimen made = make_specimen(spec, 1);
        save_packing(made, file_);
        SpecimenSpec from_file = spec;
        from_file.packing_file = file_;
        const Specimen loaded = make_specimen(from_file, 99);  // the seed plays no part
        ASSERT_EQ(loaded.packing.centres.size(), made.packing.centres.size());
        EXPECT_EQ(
            std::memcmp(loaded.packing.centres.data(), made.packing.centres.data(), made.packing.centres.size() * sizeof(Vec2)),
            0);
        EXPECT_EQ(loaded.packing.radii_m, made.packing.radii_m);
        EXPECT_EQ(loaded.packing.residual, made.packing.residual);
        EXPECT_EQ(loaded.packing.overlap_mean, made.packing.overlap_mean);
        EXPECT_EQ(loaded.mesh.nodes, made.mesh.nodes);
        EXPECT_EQ(loaded.mesh.triangles, made.mesh.triangles);
    }
}

TEST_F(PackingFile, DamageIsFoundInItsLine) {
    const Specimen made = make_specimen(rectangle(0.02, 0.02), 1);
    save_packing(made, file_);
    const std::string good = text();
    const auto with_line = [&](int number, const std::string& line) {
        std::istringstream in(good);
        std::string result, old;
        for (int k = 1; std::getline(in, old); ++k) result += (k == number ? line : old) + "\n";
        return result;
    };
    // 1 title, 2 seed, 3 polygon 4, 4-7 vertices, 8 relaxation, 9 discs n, 10 ... discs, end
    const std::vector<std::pair<int, std::string>> damages = {
        {1, "something else"},     {2, "sead 1"},           {3, "polygon four"},      {5, "0.02 x"},     {6, "0.02 0.03"},
        {8, "relaxation 1 2 3"},   {9, "discs -1"},         {9, "discs 2.5"},         {12, "0.01 0.01"}, {12, "0.01 nan 0.001"},
        {12, "0.01 0.01 0.001 1"}, {12, "0.05 0.01 0.001"}, {12, "0.01 0.01 -0.001"}, {12, ""}};
    for (const auto& [line, replacement] : damages) {
        write(with_line(line, replacement));
        EXPECT_EQ(line_of_error(made.outline), line) << replacement;
    }
    write(good);
    EXPECT_EQ(line_of_error(made.outline), 0);
}

TEST_F(PackingFile, CutShortOrMissingIsRefused) {
    const Specimen made = make_specimen(rectangle(0.02, 0.02), 1);
    EXPECT_THROW(load_packing(file_, made.outline), InputError);
    save_packing(made, file_);
    const std::string good = text();
    for (std::size_t length = 0; length < good.size() - 4; length += 37) {
        write(good.substr(0, length));
        EXPECT_THROW(load_packing(file_, made.outline), InputError) << length << " characters";
    }
}

TEST_F(PackingFile, AnotherOutlineIsRefused) {
    const Specimen made = make_specimen(rectangle(0.02, 0.02), 1);
    save_packing(made, file_);
    EXPECT_THROW(load_packing(file_, make_outline(rectangle(0.02, 0.03).outline)), InputError);
    EXPECT_THROW(load_packing(file_, make_outline(disc(0.02).outline)), InputError);
    EXPECT_THROW(load_packing(file_, make_outline(ell().outline)), InputError);
}

TEST_F(PackingFile, PlaceThatCannotBeWrittenIsAnOutputError) {
    const Specimen made = make_specimen(rectangle(0.02, 0.02), 1);
    EXPECT_THROW(save_packing(made, file_ / "no" / "such" / "folder"), OutputError);
}

// A packing of minerals with sizes of their own says which disc is of which, by name.
TEST_F(PackingFile, KeepsTheMineralsOfItsGrains) {
    SpecimenSpec spec = rectangle(0.03, 0.03);
    GrainSizeSpec fine, coarse;
    fine.minimum_m = 0.0015;
    fine.maximum_m = 0.002;
    coarse.minimum_m = 0.003;
    coarse.maximum_m = 0.005;
    spec.phase_sizes = {{"quartz", 0.4, fine}, {"feldspar", 0.6, coarse}};
    spec.grain_sizes = mixture_of(spec.phase_sizes, spec.porosity);
    const Specimen made = make_specimen(spec, 1);
    save_packing(made, file_);
    SpecimenSpec from_file = spec;
    from_file.packing_file = file_;
    const Specimen loaded = make_specimen(from_file, 99);
    EXPECT_EQ(loaded.packing.phases, made.packing.phases);
    EXPECT_EQ(loaded.packing.radii_m, made.packing.radii_m);
    std::swap(from_file.phase_sizes[0], from_file.phase_sizes[1]);  // the names count, not the numbers
    const Specimen swapped = make_specimen(from_file, 1);
    for (std::size_t i = 0; i < made.packing.phases.size(); ++i) ASSERT_EQ(swapped.packing.phases[i], 1 - made.packing.phases[i]);
    from_file.phase_sizes[0].name = "biotite";
    EXPECT_THROW(make_specimen(from_file, 1), InputError) << "another rock";
    from_file.phase_sizes.clear();  // minerals without sizes are drawn anew, which is told
    const Specimen without = make_specimen(from_file, 1);
    EXPECT_TRUE(without.packing.phases.empty());
    ASSERT_FALSE(without.quality.warnings.empty());
    EXPECT_NE(without.quality.warnings.front().find("which does not count"), std::string::npos);

    std::string damaged = text();
    const std::size_t last = damaged.rfind(" 0\n");
    write(damaged.substr(0, last) + " 2\n" + damaged.substr(last + 3));
    EXPECT_GT(line_of_error(make_outline(spec)), 8);
    save_packing(make_specimen(rectangle(0.03, 0.03), 1), file_);
    from_file = spec;
    from_file.packing_file = file_;
    EXPECT_THROW(make_specimen(from_file, 1), InputError) << "it does not say of which mineral";
}

}  // namespace
}  // namespace feldspar
