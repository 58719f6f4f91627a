// A laboratory result made up by hand: a wall of square grains, a few cracks, three snapshots. Enough to read every file back.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "feldspar/lab/acoustic_emission.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar::testing {

/// nx times ny square grains of 1 mm, each with four vertices, a centre node and four triangles.
inline std::shared_ptr<const Specimen> make_wall(int nx, int ny, std::uint64_t seed) {
    auto specimen = std::make_shared<Specimen>();
    const double side = 1e-3;
    specimen->seed = seed;
    specimen->spec.outline.width_m = nx * side;
    specimen->spec.outline.height_m = ny * side;
    for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) specimen->cells.vertices.push_back({i * side, j * side});
    }
    const auto vertex = [&](int i, int j) { return j * (nx + 1) + i; };
    const auto grain = [&](int i, int j) { return i < 0 || j < 0 || i >= nx || j >= ny ? -1 : j * nx + i; };
    GrainMesh& mesh = specimen->mesh;
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            Cell cell;
            cell.vertices = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
            cell.neighbours = {grain(i, j - 1), grain(i + 1, j), grain(i, j + 1), grain(i - 1, j)};
            cell.outline_edges = {j == 0 ? 0 : -1, i == nx - 1 ? 1 : -1, j == ny - 1 ? 2 : -1, i == 0 ? 3 : -1};
            const int first = static_cast<int>(mesh.nodes.size());
            mesh.node_begin.push_back(first);
            mesh.triangle_begin.push_back(static_cast<int>(mesh.triangles.size()));
            mesh.edge_begin.push_back(static_cast<int>(mesh.edge_triangle.size()));
            for (const int v : cell.vertices) mesh.nodes.push_back(specimen->cells.vertices[static_cast<std::size_t>(v)]);
            mesh.nodes.push_back({(i + 0.5) * side, (j + 0.5) * side});
            for (int k = 0; k < 4; ++k) {
                mesh.edge_triangle.push_back(static_cast<int>(mesh.triangles.size()));
                mesh.triangles.push_back({first + k, first + (k + 1) % 4, first + 4});
            }
            mesh.vertex_count.push_back(4);
            mesh.centre_node.push_back(first + 4);
            specimen->cells.cells.push_back(cell);
        }
    }
    mesh.node_begin.push_back(static_cast<int>(mesh.nodes.size()));
    mesh.triangle_begin.push_back(static_cast<int>(mesh.triangles.size()));
    mesh.edge_begin.push_back(static_cast<int>(mesh.edge_triangle.size()));
    SpecimenQuality& quality = specimen->quality;
    quality.grains = nx * ny;
    quality.contacts = (nx - 1) * ny + nx * (ny - 1);
    quality.nodes = static_cast<int>(mesh.nodes.size());
    quality.triangles = static_cast<int>(mesh.triangles.size());
    quality.merged_edges = 2;
    quality.vertices_per_grain = 4.0;
    return specimen;
}

/// Two cracks: tensile on the vertical edge between grains 0 and 1, shear on the horizontal edge between grain 0 and the one
/// above it.
inline TestResult make_result(MethodId kind = methods::uniaxial_compression, std::uint64_t seed = 3, int nx = 4, int ny = 3) {
    TestResult result;
    result.test.kind = kind;
    result.test.sigma3_Pa = kind == methods::biaxial ? 4e6 : 0.0;
    result.seed = seed;
    result.specimen = make_wall(nx, ny, seed);
    result.threads = 2;
    result.steps = 1000;
    result.stop_reason = "the stress fell to 80 % of the peak";
    for (int r = 0; r <= 20; ++r) {
        HistoryRow row;
        row.phase = r == 0 ? Phase::elastic : Phase::loading;
        row.step = 50LL * r;
        row.axial_strain = 2.5e-4 * r;
        row.axial_strain_gauge = 2.4e-4 * r;
        row.lateral_strain_gauge = -0.6e-4 * r;
        row.platen_displacement_m = row.axial_strain * 0.003;
        row.axial_stress_Pa = 1e8 * std::sin(0.1 * r) / 3.0;
        row.stress_top_Pa = row.axial_stress_Pa * 1.001;
        row.stress_bottom_Pa = row.axial_stress_Pa * 0.999;
        row.cracks_tensile = r > 10 ? 1 : 0;
        row.cracks_shear = r > 15 ? 1 : 0;
        row.residual = 1e-3;
        row.residual_median = 8e-4;
        row.platen_speed = 1e-9;
        row.energy.external = 0.01 * r * r;
        row.energy.elastic_grains = 0.009 * r * r;
        row.energy.fracture = 0.001 * r * r;
        result.history.push_back(row);
    }
    const auto crack = [&](int a, int b, Vec2 from, Vec2 to, CrackMode mode, int row) {
        Crack c;
        c.step = 50LL * row;
        c.axial_strain = 2.5e-4 * row;
        c.axial_stress_Pa = result.history[static_cast<std::size_t>(row)].axial_stress_Pa;
        c.mode = mode;
        c.grain_a = a;
        c.grain_b = b;
        c.from = from;
        c.to = to;
        c.place = 0.5 * (from + to);
        c.area_m2 = 8e-5;
        c.energy_J = 1.6e-3;
        result.cracks.push_back(c);
    };
    crack(0, 1, {1e-3, 0.25e-3}, {1e-3, 0.75e-3}, CrackMode::tensile, 11);
    crack(0, nx, {0.0, 1e-3}, {0.5e-3, 1e-3}, CrackMode::shear, 16);
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const double x = (i + 1) * 1e-3, y = (j + 1) * 1e-3;
            if (i + 1 < nx) result.grain_contacts.push_back({j * nx + i, j * nx + i + 1, {x, y - 1e-3}, {x, y}});
            if (j + 1 < ny) result.grain_contacts.push_back({j * nx + i, (j + 1) * nx + i, {x, y}, {x - 1e-3, y}});
        }
    const auto snapshot = [&](const char* label, int row, int cracks) {
        Snapshot s;
        s.label = label;
        s.step = 50LL * row;
        s.axial_strain = 2.5e-4 * row;
        s.axial_stress_Pa = result.history[static_cast<std::size_t>(row)].axial_stress_Pa;
        for (const Vec2 node : result.specimen->mesh.nodes)
            s.displacement_m.push_back({0.25 * s.axial_strain * node.x, -s.axial_strain * node.y});
        // grain 1 moves away from grain 0, so that the tensile crack opens by 1 um
        if (cracks > 0) {
            for (int n = 5; n < 10; ++n) s.displacement_m[static_cast<std::size_t>(n)].x += 1e-6;
        }
        for (std::size_t t = 0; t < result.specimen->mesh.triangles.size(); ++t) {
            s.stress_xx_Pa.push_back(1e5 * static_cast<double>(t % 7));
            s.stress_yy_Pa.push_back(s.axial_stress_Pa);
            s.stress_xy_Pa.push_back(1e4 * static_cast<double>(t % 3));
            s.damage.push_back(cracks > 0 && t == 1 ? 1.0F : 0.0F);
        }
        s.cracks = cracks;
        s.crack_opening_m.assign(static_cast<std::size_t>(cracks), 1e-6);
        for (std::size_t c = 0; c < result.grain_contacts.size(); ++c) {  // the first two are those of the cracks
            s.contact_damage.push_back(static_cast<int>(c) < cracks ? 1.0F : 0.01F * static_cast<float>(c));
            s.contact_normal_N.push_back(static_cast<int>(c) < cracks ? 0.0F : 10.0F * static_cast<float>(c));
            s.contact_shear_N.push_back(static_cast<int>(c) < cracks ? 0.0F : -1.0F * static_cast<float>(c));
        }
        result.snapshots.push_back(s);
    };
    snapshot("start", 1, 0);
    snapshot("first-crack", 11, 1);
    snapshot("end", 20, 2);
    const double undefined = std::numeric_limits<double>::quiet_NaN();
    result.properties = {.peak_stress_Pa = 122.1e6,
                         .peak_reached = true,
                         .first_crack_Pa = 40e6,
                         .E_secant_Pa = 25e9,
                         .E_tangent_Pa = 24e9,
                         .E_average_Pa = 24.5e9,
                         .E_gauge_Pa = 24.1e9,
                         .nu = kind == methods::brazilian ? undefined : 0.23,
                         .nu_tangent = kind == methods::brazilian ? undefined : 0.25,
                         .E_initial_Pa = 25.5e9,
                         .nu_initial = kind == methods::brazilian ? undefined : 0.22,
                         .sigma_ci_crack_count_Pa = 50e6,
                         .sigma_ci_crack_volume_Pa = undefined,
                         .sigma_ci_lateral_strain_Pa = 52e6,
                         .sigma_cd_Pa = undefined,
                         .section_width_m = kind == methods::brazilian ? undefined : 0.08,
                         .remarks = {"A remark on the numbers."}};
    result.evidence.error_estimate = 0.004;
    result.evidence.residual_mean = 0.002;
    result.evidence.grade = 'A';
    result.evidence.verdict = "Quasi-static to about 0.5 %.";
    result.energy_at_end = result.history.back().energy;
    result.emission = acoustic_emission(result);
    return result;
}

inline Job make_job() {
    Job job;
    job.name = "augig";
    job.file = "augig.toml";
    job.text = "name = \"augig\"\n[specimen]\nshape = \"rectangle\"\nwidth = \"4 mm\"\nheight = \"3 mm\"\n";
    job.seeds = {3, 4};
    job.laboratory = {{"UCS", 122.1e6}, {"E", 25.8e9}, {"friction_angle", 0.925}, {"cohesion", 21e6}, {"nu", 0.23}};
    return job;
}

/// Two ways to model the same packings; the second is twice as dear.
inline std::vector<Variant> make_variants() {
    std::vector<Variant> variants(2);
    variants[0].name = "rigid, brittle";
    variants[0].model.kind = GrainKind::rigid;
    variants[0].contact.law = ContactLaw::brittle;
    variants[1].name = "inner particles";
    variants[1].model = {GrainKind::inner_particles, ContactKind::point, ContactNormal::edge, PlaneState::stress};
    for (Variant& variant : variants) variant.stem = variant_stem(variant.name);
    return variants;
}

inline TestResult make_result_of(const Variant& variant, std::uint64_t seed) {
    TestResult result = make_result(methods::uniaxial_compression, seed);
    result.variant = variant.name;
    result.model = variant.model;
    result.contact = variant.contact;
    result.ms_per_step = variant.model.kind == GrainKind::rigid ? 1.0 : 2.0;
    return result;
}

inline Provenance make_provenance() {
    return {.version = "0.1.0",
            .commit = "abc",
            .machine = "a machine",
            .compiler = "a compiler",
            .started = "2026-01-01T00:00:00Z",
            .command_line = "feldspar run augig.toml",
            .threads = 2,
            .device = {}};
}

inline PropertySummary make_properties() {
    PropertySummary properties;
    properties.values["E_Pa"] = {25e9, 24e9, 26e9, {3, 4}, {}};
    properties.values["UCS_Pa"] = {120e6, 110e6, 130e6, {3, 4}, {}};
    properties.values["nu"] = {0.23, 0.22, 0.24, {3, 4}, {}};
    properties.values["friction_angle_deg"] = {52.0, 51.0, 53.0, {3}, {}};
    properties.values["cohesion_Pa"] = {20e6, 19e6, 21e6, {3}, {}};
    properties.values["hoek_brown_mi"] = {std::numeric_limits<double>::quiet_NaN(), 1.0, 2.0, {3}, {}};
    properties.fits.push_back({.seed = 3,
                               .cohesion_Pa = 20e6,
                               .friction_angle_deg = 52.0,
                               .UCS_fitted_Pa = 116e6,
                               .hoek_brown_mi = 20.0,
                               .hoek_brown_UCS_Pa = 118e6,
                               .UCS_measured_Pa = 120e6,
                               .sigma3_Pa = {0.0, 4e6, 10e6},
                               .sigma1_Pa = {120e6, 150e6, 200e6}});
    properties.envelope_method = "Mohr-Coulomb through three tests";
    return properties;
}

}  // namespace feldspar::testing
