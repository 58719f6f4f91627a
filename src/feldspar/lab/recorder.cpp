#include "feldspar/lab/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "feldspar/base/angle.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/grain_fields.hpp"

namespace feldspar {
namespace {

// The share of the grain edge that a contact point stands for, in the undeformed state.
struct EdgeShare {
    double from, to, middle;
};

EdgeShare share_of_edge(int point, int points) {
    if (points == 1) return {0.0, 1.0, 0.5};
    constexpr EdgeShare kLobatto[3] = {{0.0, 1.0 / 6.0, 0.0}, {1.0 / 6.0, 5.0 / 6.0, 0.5}, {5.0 / 6.0, 1.0, 1.0}};
    return kLobatto[point];
}

// Between the ends of the outermost grain edges that press on a plate, seen from the centre of the disc.
double contact_arc_deg(const Experiment& e, int side) {
    const Assembly& assembly = e.assembly;
    const Vec2 centre = e.setup.specimen->outline.centre;
    double least = 0.0, most = 0.0;
    bool any = false;
    for (std::size_t c = assembly.contacts.size(); c-- > 0;) {
        const Contact& contact = assembly.contacts[c];
        if (!contact.plate || contact.b.body != assembly.fixtures[side].plate) continue;
        if (!(assembly.bond(contact.first_point).Fn_N > 0.0)) continue;
        for (const Vec2 end : {assembly.origins[c].from, assembly.origins[c].to}) {
            const double angle = std::atan2(end.x - centre.x, std::abs(end.y - centre.y));
            least = any ? std::min(least, angle) : angle;
            most = any ? std::max(most, angle) : angle;
            any = true;
        }
    }
    return in_degrees(most - least);
}

}  // namespace

Recorder::Recorder(const Experiment& experiment, TestResult& result) : e_(experiment), result_(result) {}

HistoryRow Recorder::present(Phase phase) {
    HistoryRow row;
    const Reactions reactions = feldspar::reactions(e_.assembly);
    row.phase = phase;
    row.step = e_.step;
    row.platen_displacement_m = e_.direction * e_.platen_travel_m;
    row.axial_strain = row.platen_displacement_m / e_.length_m;
    row.axial_strain_gauge = e_.gauge.axial(e_.assembly);
    row.lateral_strain_gauge = e_.gauge.lateral(e_.assembly);
    row.stress_top_Pa = e_.stress(reactions.loading);
    row.stress_bottom_Pa = e_.stress(reactions.rest);
    row.axial_stress_Pa = 0.5 * (row.stress_top_Pa + row.stress_bottom_Pa);
    row.sigma3_Pa = e_.confining_Pa();
    row.stage = e_.stage;
    row.cracks_tensile = now_.tensile;
    row.cracks_shear = now_.shear;
    const double force = 0.5 * (std::abs(reactions.loading) + std::abs(reactions.rest));
    now_.unbalanced = feldspar::unbalanced(e_.assembly);
    row.residual = force > 0.0 ? now_.unbalanced.total_N / force : 0.0;
    row.residual_median = force > 0.0 ? now_.unbalanced.typical_N / force : 0.0;
    row.platen_speed = e_.settings.speed;
    if (e_.method.reading == Reading::disc) {
        row.contact_arc_top_deg = contact_arc_deg(e_, 0);
        row.contact_arc_bottom_deg = contact_arc_deg(e_, 1);
    }
    StepSettings last = e_.settings;
    if (!e_.stepped) last.dt = 0.0;
    const StoredEnergy stored = stored_energy(e_.assembly, last.dt);
    const Motion moving = motion(e_.assembly, last);
    row.kinetic_deviation = moving.deviation_J;  // local damping: the loading mode is zero, and this is all motion
    row.energy.external = e_.platen_work.loading + stored.pressure_J - moving.ahead_external_J;
    if (!e_.full_weight.empty()) row.energy.external += e_.weight_work(last.dt) - e_.weight_start_J;
    row.energy.elastic_start = e_.elastic_start_J;
    row.energy.rate_control = e_.rate_control_J;
    row.energy.elastic_grains = stored.grains_J;
    row.energy.elastic_contacts = stored.contacts_J;
    row.energy.fracture = stored.fracture_J;
    row.energy.friction = stored.friction_J;
    row.energy.damping = stored.damping_J - moving.ahead_damping_J;
    row.energy.kinetic = moving.kinetic_J;
    row.gauges = e_.gauges.read(e_.assembly, row.energy);
    return row;
}

void Recorder::elastic_phase(const HistoryRow& from) {
    constexpr int kRows = 20;
    const HistoryRow to = present(Phase::elastic);
    const int first = result_.history.empty() ? 0 : 1;  // the row at `from` may stand there already
    const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
    for (int i = first; i < kRows; ++i) {
        const double share = static_cast<double>(i) / kRows;
        HistoryRow row = to;
        for (double HistoryRow::*value :
             {&HistoryRow::platen_displacement_m, &HistoryRow::axial_strain, &HistoryRow::axial_strain_gauge,
              &HistoryRow::lateral_strain_gauge, &HistoryRow::stress_top_Pa, &HistoryRow::stress_bottom_Pa,
              &HistoryRow::axial_stress_Pa})
            row.*value = mix(from.*value, to.*value, share);
        for (std::size_t g = 0; g < row.gauges.size(); ++g)
            row.gauges[g] = mix(g < from.gauges.size() ? from.gauges[g] : 0.0, to.gauges[g], share);
        // Energies grow with the square of the load only from an unloaded start; elsewhere they follow the two states.
        for (double EnergyLedger::*value :
             {&EnergyLedger::elastic_grains, &EnergyLedger::elastic_contacts, &EnergyLedger::elastic_start})
            row.energy.*value = from.axial_stress_Pa == 0.0 ? share * share * (to.energy.*value)
                                                            : mix(from.energy.*value, to.energy.*value, share);
        row.energy.rate_control = row.energy.kinetic = row.kinetic_deviation = row.residual = row.residual_median =
            row.platen_speed = 0.0;
        e_.gauges.read_energies(row.energy, row.gauges);
        result_.history.push_back(row);
    }
}

const HistoryRow& Recorder::record(Phase phase) {
    collect_cracks();
    result_.history.push_back(present(phase));
    const HistoryRow& row = result_.history.back();
    for (std::size_t c = result_.cracks.size();
         c-- > 0 && result_.cracks[c].step >= now_.cracks_seen_until;) {  // those of this interval
        result_.cracks[c].axial_strain = row.axial_strain;
        result_.cracks[c].axial_stress_Pa = row.axial_stress_Pa;
    }
    now_.cracks_seen_until = e_.step;
    keep_snapshots(row);
    return row;
}

void Recorder::collect_cracks() {
    struct Found {
        long long step;
        int contact, point;
    };
    std::vector<Found> found;
    const std::vector<Contact>& contacts = e_.assembly.contacts;  // in the order of their points
    for (int p = 0; p < std::ssize(e_.assembly.points); ++p) {
        const long long step = e_.assembly.points[p].broken_step;
        if (step < std::max(0LL, now_.cracks_seen_until)) continue;
        const auto behind = std::upper_bound(contacts.begin(), contacts.end(), p,
                                             [](int point, const Contact& c) { return point < c.first_point; });
        found.push_back({step, static_cast<int>(behind - contacts.begin()) - 1, p});
    }
    std::stable_sort(found.begin(), found.end(), [](const Found& l, const Found& r) { return l.step < r.step; });
    for (const Found& f : found) {
        const Contact& contact = e_.assembly.contacts[f.contact];
        const ContactPoint& point = e_.assembly.points[f.point];
        const auto [edge_a, edge_b, p0, p1] = e_.assembly.origins[f.contact];
        const EdgeShare share = share_of_edge(f.point - contact.first_point, contact.points);
        Crack crack;
        crack.step = f.step;
        crack.mode = point.broke_in_tension ? CrackMode::tensile : CrackMode::shear;
        crack.grain_a = e_.assembly.bodies[contact.a.body].grain;
        crack.grain_b = e_.assembly.bodies[contact.b.body].grain;
        crack.contact = f.contact;
        crack.point = f.point - contact.first_point;
        crack.from = p0 + share.from * (p1 - p0);
        crack.to = p0 + share.to * (p1 - p0);
        crack.place = p0 + share.middle * (p1 - p0);
        crack.area_m2 = point.area_m2;
        crack.energy_J = point.broken_J;
        const BondState bond = e_.assembly.bond(f.point);
        crack.normal = contact_frame(e_.assembly, contact).n;
        crack.opening_m = bond.un_m;
        crack.slip_m = bond.us_m;
        ++(crack.mode == CrackMode::tensile ? now_.tensile : now_.shear);
        result_.cracks.push_back(crack);
        now_.crack_points.push_back(f.point);
    }
}

Recorder::Fields Recorder::fields(const std::string& label, const HistoryRow& row) const {
    Fields f{label, row, e_.assembly.nodes.displacement, {}, {}, {}, {}, {}, {}, static_cast<int>(result_.cracks.size())};
    if (e_.assembly.triangles.empty()) f.grain_stress = grain_stresses(e_.assembly, *result_.specimen);
    f.damage.reserve(e_.assembly.points.size());
    f.opening.reserve(e_.assembly.points.size());
    for (const ContactPoint& point : e_.assembly.points) {
        f.damage.push_back(static_cast<float>(e_.assembly.bonds.damage[point.state]));
        f.opening.push_back(e_.assembly.bonds.un_m[point.state]);
    }
    if (!e_.assembly.dilations.empty())
        for (const Contact& contact : e_.assembly.contacts)
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
                f.opening[p] += e_.assembly.dilated_m(contact, p);
    for (const Contact& contact : e_.assembly.contacts) {
        if (!joins_grains(contact)) continue;
        double damage = 0.0, normal = 0.0, shear = 0.0;
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
            const BondState bond = e_.assembly.bond(p);
            damage = std::max(damage, bond.damage);
            normal += bond.Fn_N;
            shear += bond.Fs_N;
        }
        f.contact_damage.push_back(static_cast<float>(damage));
        f.contact_normal.push_back(static_cast<float>(normal));
        f.contact_shear.push_back(static_cast<float>(shear));
    }
    return f;
}

// New contacts come behind those of the initial assembly, which stay in the list when they are dropped.
bool Recorder::joins_grains(const Contact& contact) const {
    return contact.material == between_grains && !contact.plate && !contact.new_contact;
}

void Recorder::name_grain_contacts() {
    for (std::size_t c = 0; c < e_.assembly.contacts.size(); ++c) {
        const Contact& contact = e_.assembly.contacts[c];
        if (!joins_grains(contact)) continue;
        const ContactOrigin& origin = e_.assembly.origins[c];
        result_.grain_contacts.push_back(
            {e_.assembly.bodies[contact.a.body].grain, e_.assembly.bodies[contact.b.body].grain, origin.from, origin.to});
    }
}

void Recorder::keep_snapshots(const HistoryRow& row) {
    if (row.phase == Phase::consolidation) return;
    const int cracks = static_cast<int>(result_.cracks.size()), most = result_.test.snapshots;
    const auto kept = [&](const char* label) { return std::make_shared<const Fields>(fields(label, row)); };
    if (!now_.start) now_.start = kept("start");
    if (cracks > 0 && !now_.first_crack) now_.first_crack = kept("first-crack");
    const double load = strength_sign() * row.axial_stress_Pa;
    if (!now_.peak || load > 1.001 * strength_sign() * now_.peak->row.axial_stress_Pa) now_.peak = kept("peak");
    if (most <= 0 || cracks == 0 || cracks < now_.next_cracks) return;
    now_.loading.push_back(kept("load"));
    if (static_cast<int>(now_.loading.size()) > 2 * most) {  // keep every second one
        std::vector<Kept> thinned;
        for (std::size_t i = 1; i < now_.loading.size(); i += 2) thinned.push_back(now_.loading[i]);
        now_.loading = std::move(thinned);
        now_.crack_spacing *= 2;
    }
    now_.next_cracks = cracks + now_.crack_spacing;
}

Recorder::Mark Recorder::mark() const { return {now_, result_.history.size(), result_.cracks.size()}; }

void Recorder::go_back_to(const Mark& mark) {
    now_ = mark.state;
    result_.history.resize(mark.rows);
    result_.cracks.resize(mark.cracks);
}

Snapshot Recorder::complete(const Fields& f) const {
    Snapshot s;
    s.label = f.label;
    s.step = f.row.step;
    s.axial_strain = f.row.axial_strain;
    s.axial_stress_Pa = f.row.axial_stress_Pa;
    s.displacement_m = mesh_displacements(e_.assembly, *result_.specimen, f.displacement);
    const GrainMesh& mesh = result_.specimen->mesh;
    const auto add_stress = [&](const Mat2& stress) {
        s.stress_xx_Pa.push_back(-stress.xx);
        s.stress_yy_Pa.push_back(-stress.yy);
        s.stress_xy_Pa.push_back(-stress.xy);
    };
    for (int b = 0; b < std::ssize(e_.assembly.bodies); ++b)  // the triangles of all bodies, in their order
        for (int t = e_.assembly.bodies[b].triangle_begin; t < e_.assembly.bodies[b].triangle_end; ++t)
            add_stress(
                cauchy_stress(e_.assembly.elasticity_of(b), displacement_gradient(f.displacement, e_.assembly.triangles[t])));
    for (std::size_t g = 0; g < f.grain_stress.size(); ++g)
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t) add_stress(f.grain_stress[g]);
    s.damage.assign(mesh.triangles.size(), 0.0F);
    for (std::size_t c = 0; c < e_.assembly.contacts.size(); ++c) {
        const Contact& contact = e_.assembly.contacts[c];
        const ContactOrigin& origin = e_.assembly.origins[c];
        if (origin.edge_a < 0) continue;
        for (const auto& [side, edge] : {std::pair{contact.a, origin.edge_a}, std::pair{contact.b, origin.edge_b}}) {
            float& damage = s.damage[mesh.edge_triangle[mesh.edge_begin[e_.assembly.bodies[side.body].grain] + edge]];
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
                damage = std::max(damage, f.damage[p]);
        }
    }
    s.cracks = f.cracks;
    for (int c = 0; c < f.cracks; ++c) s.crack_opening_m.push_back(f.opening[now_.crack_points[c]]);
    s.contact_damage = f.contact_damage;
    s.contact_normal_N = f.contact_normal;
    s.contact_shear_N = f.contact_shear;
    return s;
}

void Recorder::finish() {
    if (result_.history.empty()) return;
    name_grain_contacts();
    std::vector<Fields> all;
    for (const Kept& one : {now_.start, now_.first_crack, now_.peak})
        if (one) all.push_back(*one);
    all.push_back(fields("end", result_.history.back()));
    const std::vector<Kept>& loading = now_.loading;
    for (std::size_t i = 0; i < loading.size(); ++i) {
        if (static_cast<int>(loading.size()) > result_.test.snapshots && i % 2 == 0) continue;
        if (std::any_of(all.begin(), all.end(), [&](const Fields& f) { return f.row.step == loading[i]->row.step; })) continue;
        all.push_back(*loading[i]);
    }
    std::stable_sort(all.begin(), all.end(), [](const Fields& l, const Fields& r) { return l.row.step < r.row.step; });
    int number = 0;
    for (Fields& f : all) {
        if (f.label == "load") f.label = "load-" + std::to_string(++number);
        result_.snapshots.push_back(complete(f));
        f = {};  // its memory is enough for a part of the next
    }
}

}  // namespace feldspar
