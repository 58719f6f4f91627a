#include "feldspar/step/advance_packs.hpp"

#include <algorithm>
#include <span>

#include "feldspar/model/attachment.hpp"

namespace feldspar {

KernelStep kernel_step(const StepSettings& settings) {
    KernelStep step;
    step.dt = settings.dt;
    step.local_damping = settings.damping == Damping::local;
    step.alpha = settings.alpha;
    step.viscous = settings.viscous;
    step.speed = settings.speed;
    step.unlimited = settings.strength == Strength::unlimited;
    return step;
}

namespace {

// What the edges of these packs feel that several contacts share.
void sum_shared_edges(Assembly& assembly, IndexRange share) {
    const auto& shared = assembly.packs.shared_edges;
    auto edge =
        std::lower_bound(shared.begin(), shared.end(), share.begin, [](const SharedEdge& e, int pack) { return e.pack < pack; });
    for (; edge != shared.end() && edge->pack < share.end; ++edge) {
        SlotForces sum;
        for (int i = edge->begin; i < edge->end; ++i) sum.add(assembly.slots[assembly.packs.shared_slots[i]]);
        assembly.packs.lines[edge->line].forces = sum;
    }
}

template <class Visit>
void for_each_pressed_grain(Assembly& assembly, IndexRange packs, Visit visit) {
    if (!assembly.is_pressed()) return;
    for (int p = packs.begin; p < packs.end; ++p) {
        if (assembly.packs.forces[p] != PackForces::on_top_of_others) continue;
        const GrainPack& pack = assembly.packs.grains[p];
        for (int lane = 0; lane < pack.lanes; ++lane)
            visit(assembly.bodies[pack.grain[lane]], assembly.body_work[pack.grain[lane]]);
    }
}

void grains_of_packs(Assembly& assembly, const KernelArrays& arrays, const KernelStep& step, const StepSettings& settings,
                     IndexRange packs) {
    sum_shared_edges(assembly, packs);
    for_each_pressed_grain(assembly, packs, [&](const Body& grain, BodyWork& work) {
        weigh(assembly, grain);
        add_pressure(assembly, grain, work, settings.dt);
    });
    settings.kernels->grains(arrays, step, packs.begin, packs.end);
    for_each_pressed_grain(assembly, packs,
                           [&](const Body& grain, BodyWork& work) { finish_pressure_work(assembly, grain, work, settings.dt); });
}

// How the edges of a grain that is in no pack move: the linear velocity fields of the triangles behind them, at the centre.
void write_lines_of(Assembly& assembly, const Body& grain) {
    const Nodes& nodes = assembly.nodes;
    const Vec2 centre = nodes.position(grain.centre_node);
    for (int e = grain.edge_begin; e < grain.edge_end; ++e) {
        const SideNodes& node = assembly.edges[e].node;
        const auto x = corners(nodes, node);
        const Vec2 e1 = x[1] - x[0], e2 = x[2] - x[0];
        const double inverse = 1.0 / cross(e1, e2);
        const Vec2 g1 = {inverse * e2.y, -inverse * e2.x}, g2 = {-inverse * e1.y, inverse * e1.x};
        const Vec2 d1 = nodes.velocity[node[1]] - nodes.velocity[node[0]], d2 = nodes.velocity[node[2]] - nodes.velocity[node[0]];
        SideField field;
        field.centre = centre;
        field.gradient = {d1.x * g1.x + d2.x * g2.x, d1.x * g1.y + d2.x * g2.y, d1.y * g1.x + d2.y * g2.x,
                          d1.y * g1.y + d2.y * g2.y};
        field.velocity = nodes.velocity[node[0]] + field.gradient * (centre - x[0]);
        assembly.packs.lines[assembly.packs.line_of_edge[e]].field = field;
    }
}

// The readable stages leave a contact's forces in its slots; packs look for them in lines.
void hand_over(Assembly& assembly, int c) {
    Packs& packs = assembly.packs;
    const Contact& contact = assembly.contacts[c];
    if (!contact.flexible) {
        const SlotForces &a = assembly.slots[2 * c], &b = assembly.slots[2 * c + 1];
        packs.rigid_forces[c] = {-a.force, turning_moment(a), turning_moment(b)};
        return;
    }
    for (int side = 0; side < 2 - contact.plate; ++side) {
        const ContactSide& s = side == 0 ? contact.a : contact.b;
        if (packs.only_contact_on(s.edge)) packs.lines[packs.line_of_edge[s.edge]].forces = assembly.slots[2 * c + side];
    }
}

// What a grain in no pack feels at edges whose contacts went through packs: back from lines to slots.
void take_over(Assembly& assembly, const Body& grain) {
    for (int i = grain.slot_begin; i < grain.slot_end; ++i) {
        const int slot = assembly.slots_of_bodies[i];
        const Contact& contact = assembly.contacts[slot / 2];
        const ContactSide& s = slot % 2 == 0 ? contact.a : contact.b;
        if (assembly.packs.only_contact_on(s.edge))
            assembly.slots[slot] = assembly.packs.lines[assembly.packs.line_of_edge[s.edge]].forces;
    }
}

}  // namespace

void PackStages::lines(const PackRanges& part) const {
    settings_.kernels->grain_lines(arrays_, part.grains.begin, part.grains.end);
    settings_.kernels->rigid_lines(arrays_, part.rigid.begin, part.rigid.end);
    for (int i = part.loose_bodies.begin; i < part.loose_bodies.end; ++i) lines_of_loose(assembly_.packs.loose_bodies[i]);
}

void PackStages::contacts(const KernelStep& step, const PackRanges& part) const {
    settings_.kernels->contacts(arrays_, step, part.contacts.begin, part.contacts.end);
    for (int i = part.loose_contacts.begin; i < part.loose_contacts.end; ++i)
        loose_contact(step, assembly_.packs.loose_contacts[i]);
}

void PackStages::bodies(const KernelStep& step, const PackRanges& part) const {
    grains_of_packs(assembly_, arrays_, step, settings_, part.grains);
    settings_.kernels->rigid(arrays_, step, part.rigid.begin, part.rigid.end);
    for (int i = part.loose_bodies.begin; i < part.loose_bodies.end; ++i) loose_body(assembly_.packs.loose_bodies[i]);
}

void PackStages::loose_contact(const KernelStep& step, int contact) const {
    contact_forces(assembly_, {contact, contact + 1}, settings_, step.step);
    hand_over(assembly_, contact);
}

void PackStages::loose_body(int body) const {
    if (assembly_.bodies[body].kind == BodyKind::flexible) take_over(assembly_, assembly_.bodies[body]);
    body_forces(assembly_, {body, body + 1}, settings_);
    lines_of_loose(body);
}

void PackStages::lines_of_loose(int body) const { write_lines_of(assembly_, assembly_.bodies[body]); }

namespace {

PackRanges whole(const Packs& packs) {
    const auto all = [](const auto& list) { return IndexRange{0, static_cast<int>(std::ssize(list))}; };
    return {all(packs.contacts), all(packs.loose_contacts), all(packs.grains), {0, packs.rigid_end}, all(packs.loose_bodies)};
}

// What a thread takes of these ranges. Loose things are few; they are shared out as well.
PackRanges share_of(const Team& team, const PackRanges& all, int thread) {
    const auto part = [&](IndexRange range) {
        const IndexRange share = team.share(range.end - range.begin, thread);
        return IndexRange{range.begin + share.begin, range.begin + share.end};
    };
    return {part(all.contacts), part(all.loose_contacts), part(all.grains), part(all.rigid), part(all.loose_bodies)};
}

}  // namespace

void write_lines(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays) {
    const PackStages stages(assembly, settings, arrays);
    team.run([&](int thread) { stages.lines(share_of(team, whole(assembly.packs), thread)); });
}

// A sweep of several steps goes from the bottom to the top in rounds. In round r, step s takes the contacts of band r - 2 s, then
// the bodies of band r - 2 s - 1: their contacts, of that band and the next, have had their turn in rounds r - 1 and r, and the
// bodies that the contacts need have made step s - 1 in rounds r - 1 and r - 2 (model/bands.hpp). What one round does of a stage
// does not depend on each other. With a single band this is one step after the other.
void advance_packs(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays, long long first_step,
                   int count, PlatenWork& work) {
    const Bands& cut = assembly.packs.bands;
    const int at_once = settings.sweep_steps > 0 ? settings.sweep_steps : cut.steps(team.size());
    const PackRanges everything = whole(assembly.packs);
    const std::span<const PackRanges> bands = at_once > 1 ? std::span(cut.ranges) : std::span(&everything, 1);
    const int last_band = static_cast<int>(bands.size()) - 1, platen_band = at_once > 1 ? cut.platen : 0;
    const double travel = settings.dt * settings.speed;
    const PackStages stages(assembly, settings, arrays);
    team.run([&](int thread) {
        KernelStep step = kernel_step(settings);
        // Calls stage(band) for all steps [begin, end) that have a band so far along, and waits for the others.
        const auto in_turn = [&](int begin, int end, int along, auto stage) {
            const int from = begin + std::max(0, (along - last_band + 1) / 2), to = std::min(end, begin + along / 2 + 1);
            if (along < 0 || from >= to) return;
            for (int k = from; k < to; ++k) {
                step.step = first_step + k;
                step.keep_forces = k + 1 == count;
                stage(share_of(team, bands[along - 2 * (k - begin)], thread));
            }
            team.barrier();
        };
        for (int begin = 0; begin < count; begin += at_once) {
            const int end = std::min(count, begin + at_once), rounds = last_band + 2 * (end - begin);
            for (int round = 0; round < rounds; ++round) {
                in_turn(begin, end, round, [&](const PackRanges& part) { stages.contacts(step, part); });
                in_turn(begin, end, round - 1, [&](const PackRanges& part) { stages.bodies(step, part); });
                // What moves the body pushes with the opposite of its reaction along its motion. Meanwhile the others may go on:
                // its node forces stay as they are until the barrier after the next contact stage.
                const int since = round - 1 - platen_band;
                if (thread == 0 && since >= 0 && since % 2 == 0 && since / 2 < end - begin)
                    work.loading += loading_reaction(assembly) * travel;
            }
        }
    });
}

}  // namespace feldspar
