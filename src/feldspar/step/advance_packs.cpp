#include "feldspar/step/advance_packs.hpp"

#include <algorithm>

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
    auto edge = std::lower_bound(shared.begin(), shared.end(), share.begin, [](const SharedEdge& e, int pack) { return e.pack < pack; });
    for (; edge != shared.end() && edge->pack < share.end; ++edge) {
        SlotForces sum;
        for (int i = edge->begin; i < edge->end; ++i) sum.add(assembly.slots[assembly.packs.shared_slots[i]]);
        assembly.packs.lines[edge->line].forces = sum;
    }
}

template <class Visit>
void for_each_pressed_grain(Assembly& assembly, IndexRange packs, Visit visit) {
    if (assembly.pressure_Pa == 0.0) return;
    for (int p = packs.begin; p < packs.end; ++p) {
        if (assembly.packs.forces[p] != PackForces::on_top_of_others) continue;
        const GrainPack& pack = assembly.packs.grains[p];
        for (int lane = 0; lane < pack.lanes; ++lane) visit(assembly.bodies[pack.grain[lane]], assembly.body_work[pack.grain[lane]]);
    }
}

void grains_of_packs(Assembly& assembly, const KernelArrays& arrays, const KernelStep& step, const StepSettings& settings, IndexRange packs) {
    sum_shared_edges(assembly, packs);
    for_each_pressed_grain(assembly, packs, [&](const Body& grain, BodyWork& work) {
        for (const int n : grain.nodes()) assembly.nodes.force[n] = {};
        add_pressure(assembly, grain, work, settings.dt);
    });
    settings.kernels->grains(arrays, step, packs.begin, packs.end);
    for_each_pressed_grain(assembly, packs, [&](const Body& grain, BodyWork& work) { finish_pressure_work(assembly, grain, work, settings.dt); });
}

// How the edges of a grain that is in no pack move: the linear velocity fields of the triangles behind them, at the centre.
void write_lines(Assembly& assembly, const Body& grain) {
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
        field.gradient = {d1.x * g1.x + d2.x * g2.x, d1.x * g1.y + d2.x * g2.y, d1.y * g1.x + d2.y * g2.x, d1.y * g1.y + d2.y * g2.y};
        field.velocity = nodes.velocity[node[0]] + field.gradient * (centre - x[0]);
        assembly.packs.lines[assembly.packs.line_of_edge[e]].field = field;
    }
}

// The readable stages leave a contact's forces in its slots; packs look for them in lines.
void hand_over(Assembly& assembly, int c) {
    Packs& packs = assembly.packs;
    const Contact& contact = assembly.contacts[c];
    for (int side = 0; side < 2 - contact.plate; ++side) {
        const ContactSide& s = side == 0 ? contact.a : contact.b;
        const SlotForces& slot = assembly.slots[2 * c + side];
        if (!contact.flexible) {
            packs.rigid_forces[2 * c + side] = {slot.force, turning_moment(slot), 0.0};
        } else if (packs.only_contact_on(s.edge)) {
            packs.lines[packs.line_of_edge[s.edge]].forces = slot;
        }
    }
}

// What a grain in no pack feels at edges whose contacts went through packs: back from lines to slots.
void take_over(Assembly& assembly, const Body& grain) {
    for (int i = grain.slot_begin; i < grain.slot_end; ++i) {
        const int slot = assembly.slots_of_bodies[i];
        const Contact& contact = assembly.contacts[slot / 2];
        const ContactSide& s = slot % 2 == 0 ? contact.a : contact.b;
        if (assembly.packs.only_contact_on(s.edge)) assembly.slots[slot] = assembly.packs.lines[assembly.packs.line_of_edge[s.edge]].forces;
    }
}

// What one thread does of a stage. Loose things are few; they are shared out as well.
class Share {
public:
    Share(Assembly& assembly, const Team& team, const StepSettings& settings, const KernelArrays& arrays, int thread)
        : assembly_(assembly), settings_(settings), arrays_(arrays) {
        const Packs& packs = assembly.packs;
        const auto share = [&](const auto& all) { return team.share(static_cast<int>(std::ssize(all)), thread); };
        contacts_ = share(packs.contacts);
        loose_contacts_ = share(packs.loose_contacts);
        grains_ = share(packs.grains);
        loose_bodies_ = share(packs.loose_bodies);
        rigid_ = team.share(packs.rigid_end, thread);
    }

    void lines() const {
        settings_.kernels->grain_lines(arrays_, grains_.begin, grains_.end);
        settings_.kernels->rigid_lines(arrays_, rigid_.begin, rigid_.end);
        for_each_loose_body([&](const Body& body, int) { write_lines(assembly_, body); });
    }
    void contacts(const KernelStep& step) const {
        settings_.kernels->contacts(arrays_, step, contacts_.begin, contacts_.end);
        for (int i = loose_contacts_.begin; i < loose_contacts_.end; ++i) {
            const int c = assembly_.packs.loose_contacts[i];
            contact_forces(assembly_, {c, c + 1}, settings_, step.step);
            hand_over(assembly_, c);
        }
    }
    void bodies(const KernelStep& step) const {
        grains_of_packs(assembly_, arrays_, step, settings_, grains_);
        settings_.kernels->rigid(arrays_, step, rigid_.begin, rigid_.end);
        for_each_loose_body([&](const Body& body, int b) {
            if (body.kind == BodyKind::flexible) take_over(assembly_, body);
            body_forces(assembly_, {b, b + 1}, settings_);
            write_lines(assembly_, body);
        });
    }

private:
    template <class Visit>
    void for_each_loose_body(Visit visit) const {
        for (int i = loose_bodies_.begin; i < loose_bodies_.end; ++i) {
            const int b = assembly_.packs.loose_bodies[i];
            visit(assembly_.bodies[b], b);
        }
    }

    Assembly& assembly_;
    const StepSettings& settings_;
    const KernelArrays& arrays_;
    IndexRange contacts_, loose_contacts_, grains_, loose_bodies_, rigid_;
};

}  // namespace

void advance_packs(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work) {
    const double travel = settings.dt * settings.speed;
    sort_out_packs(assembly);
    const KernelArrays arrays(assembly);
    team.run([&](int thread) {
        const Share share(assembly, team, settings, arrays, thread);
        KernelStep step = kernel_step(settings);
        share.lines();   // whatever was done to the nodes since the last block
        team.barrier();
        for (int k = 0; k < count; ++k) {
            step.step = first_step + k;
            step.keep_forces = k + 1 == count;
            share.contacts(step);
            team.barrier();
            share.bodies(step);
            team.barrier();
            // The platen pushes with the opposite of its reaction along its mode. Meanwhile the others may go on: its node forces stay
            // as they are until the barrier after the next contact stage.
            if (thread == 0) work.loading -= platen_reactions(assembly).loading * assembly.platens[0].mode.y * travel;
        }
    });
}

}  // namespace feldspar
