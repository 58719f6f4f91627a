#include "feldspar/ranks/share.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace feldspar {
namespace {

// Consecutive parts of about equal weight, each with at least one of them if there are enough: where each begins, and the end.
std::vector<int> cut(const std::vector<double>& weights, int parts) {
    const int count = static_cast<int>(weights.size());
    std::vector<double> sums(weights.size() + 1, 0.0);
    std::partial_sum(weights.begin(), weights.end(), sums.begin() + 1);
    std::vector<int> begin{0};
    for (int part = 1; part < parts; ++part) {
        const auto at = std::lower_bound(sums.begin(), sums.end(), sums.back() * part / parts) - sums.begin();
        const int least = std::min(count, begin.back() + 1), most = std::max(least, count - (parts - part));
        begin.push_back(std::clamp(static_cast<int>(at), least, most));
    }
    begin.push_back(count);
    return begin;
}

bool is_loose_grain(const Assembly& assembly, int body) { return assembly.bodies[body].kind == BodyKind::flexible; }

double height(const Assembly& assembly, int body) { return assembly.nodes.reference[assembly.bodies[body].centre_node].y; }

// Bodies by their height, those in no pack too: a plate goes with the grains beside it.
std::vector<OwnPart> own_parts(const Assembly& assembly, int size) {
    const Packs& packs = assembly.packs;
    std::vector<OwnPart> parts(static_cast<std::size_t>(size));
    std::vector<double> weights;
    for (const GrainPack& pack : packs.grains) weights.push_back(pack.vertices * pack.lanes);
    const auto grains = static_cast<int>(weights.size());
    weights.resize(weights.size() + static_cast<std::size_t>(packs.rigid_end), 1.0);

    std::vector<std::int32_t> loose = packs.loose_bodies;
    std::stable_sort(loose.begin(), loose.end(), [&](int l, int r) { return height(assembly, l) < height(assembly, r); });
    std::vector<double> up_to(parts.size(), 0.0);  // height of the highest body of each part
    if (weights.empty()) {
        std::vector<double> triangles;
        for (const int b : loose) triangles.push_back(assembly.bodies[b].node_count);
        const std::vector<int> begin = cut(triangles, size);
        for (std::size_t part = 0; part < parts.size(); ++part)
            for (int i = begin[part]; i < begin[part + 1]; ++i)
                parts[part].loose_bodies.push_back(loose[static_cast<std::size_t>(i)]);
    } else {
        const std::vector<int> begin = cut(weights, size);
        for (std::size_t part = 0; part < parts.size(); ++part) {
            OwnPart& own = parts[part];
            own.grains = {std::min(begin[part], grains), std::min(begin[part + 1], grains)};
            own.rigid = {std::max(0, begin[part] - grains), std::max(0, begin[part + 1] - grains)};
            const int last = begin[part + 1] - 1;
            up_to[part] = height(assembly, last < grains ? packs.grains[last].grain[0] : last - grains);
        }
        for (const int b : loose) {
            std::size_t part = 0;
            while (part + 1 < parts.size() && height(assembly, b) > up_to[part]) ++part;
            parts[part].loose_bodies.push_back(b);
        }
    }
    for (OwnPart& own : parts) {
        const auto add_nodes = [&own](int begin, int end) {
            if (!own.nodes.empty() && own.nodes.back().end == begin)
                own.nodes.back().end = end;
            else
                own.nodes.push_back({begin, end});
        };
        const auto add_body = [&](int b) {
            const Body& body = assembly.bodies[b];
            own.bodies.push_back(b);
            if (body.node_stride == 1) return add_nodes(body.first_node, body.first_node + body.node_count);
            for (const int n : body.nodes()) add_nodes(n, n + 1);
        };
        for (int p = own.grains.begin; p < own.grains.end; ++p) {
            const GrainPack& pack = packs.grains[p];
            add_nodes(pack.first_node, pack.first_node + pack.nodes() * pack.lanes);
            own.bodies.insert(own.bodies.end(), pack.grain.begin(), pack.grain.begin() + pack.lanes);
        }
        for (int b = own.rigid.begin; b < own.rigid.end; ++b) add_body(b);
        for (const int b : own.loose_bodies) add_body(b);
    }
    return parts;
}

// Those at whose bodies a contact is: one, or two.
struct Owners {
    int a, b;
    bool has(int rank) const { return a == rank || b == rank; }
};

// Nodes that a contact's side reads of its body.
void add_nodes_of(const Assembly& assembly, const ContactSide& side, std::set<std::int32_t>& nodes) {
    const Body& body = assembly.bodies[side.body];
    nodes.insert(body.centre_node);
    if (body.kind == BodyKind::flexible) nodes.insert(side.node.begin(), side.node.end());
    if (body.kind == BodyKind::rigid) nodes.insert(body.centre_node + 1);  // its turn
}

}  // namespace

int units_to_share(const Assembly& assembly) {
    const Packs& packs = assembly.packs;
    const auto loose =
        std::count_if(packs.loose_bodies.begin(), packs.loose_bodies.end(), [&](int b) { return is_loose_grain(assembly, b); });
    const int packed = static_cast<int>(packs.grains.size()) + packs.rigid_end;
    return packed > 0 ? packed : static_cast<int>(loose);
}

Share share_of_rank(const Assembly& assembly, int rank, int size) {
    const Packs& packs = assembly.packs;
    Share share;
    share.parts = own_parts(assembly, size);
    std::vector<int> rank_of(assembly.bodies.size(), 0);
    for (int r = 0; r < size; ++r)
        for (const int b : share.parts[static_cast<std::size_t>(r)].bodies) rank_of[static_cast<std::size_t>(b)] = r;
    const auto owners = [&](int c) {
        const Contact& contact = assembly.contacts[c];
        return Owners{rank_of[static_cast<std::size_t>(contact.a.body)], rank_of[static_cast<std::size_t>(contact.b.body)]};
    };

    struct Told {
        std::set<std::int32_t> lines, nodes;
    };
    std::vector<Told> out(static_cast<std::size_t>(size)), in(static_cast<std::size_t>(size));
    // A contact that `reader` computes needs of `owner` how the side moves.
    const auto tell = [&](int owner, int reader, const auto& add) {
        if (owner == reader) return;
        if (owner == rank) add(out[static_cast<std::size_t>(reader)]);
        if (reader == rank) add(in[static_cast<std::size_t>(owner)]);
    };

    std::vector<int> readers;
    for (std::size_t p = 0; p < packs.contacts.size(); ++p) {
        const ContactPack& pack = packs.contacts[p];
        const auto takes_part = [&](int lane) { return (pack.active >> lane & 1U) != 0; };
        readers.clear();
        for (int lane = 0; lane < pack.lanes; ++lane) {
            if (!takes_part(lane)) continue;
            const Owners of = owners(pack.first_contact + lane);
            readers.insert(readers.end(), {of.a, of.b});
        }
        std::sort(readers.begin(), readers.end());
        readers.erase(std::unique(readers.begin(), readers.end()), readers.end());
        const std::size_t keeper = readers.empty() ? 0 : static_cast<std::size_t>(readers.front());
        share.parts[keeper].contact_packs.push_back(static_cast<std::int32_t>(p));
        if (std::find(readers.begin(), readers.end(), rank) != readers.end())
            share.contact_packs.push_back(static_cast<std::int32_t>(p));
        if (readers.size() < 2) continue;
        for (int lane = 0; lane < pack.lanes; ++lane) {
            if (!takes_part(lane)) continue;
            const Owners of = owners(pack.first_contact + lane);
            const std::size_t at = kMostLanes * p + static_cast<std::size_t>(lane);
            for (const int reader : readers)
                for (const auto& [owner, bytes] : {std::pair{of.a, packs.line_a[at]}, std::pair{of.b, packs.line_b[at]}})
                    tell(owner, reader,
                         [line = static_cast<std::int32_t>(bytes / sizeof(SideLine))](Told& told) { told.lines.insert(line); });
        }
    }
    for (const int c : packs.loose_contacts) {
        const Owners of = owners(c);
        share.parts[static_cast<std::size_t>(of.a)].loose_contacts.push_back(c);
        if (of.has(rank)) share.loose_contacts.push_back(c);
        const Contact& contact = assembly.contacts[c];
        tell(of.a, of.b, [&](Told& told) { add_nodes_of(assembly, contact.a, told.nodes); });
        tell(of.b, of.a, [&](Told& told) { add_nodes_of(assembly, contact.b, told.nodes); });
    }

    for (int other = 0; other < size; ++other) {
        const Told &to = out[static_cast<std::size_t>(other)], &from = in[static_cast<std::size_t>(other)];
        if (to.lines.empty() && to.nodes.empty() && from.lines.empty() && from.nodes.empty()) continue;
        share.borders.push_back({other,
                                 {to.lines.begin(), to.lines.end()},
                                 {from.lines.begin(), from.lines.end()},
                                 {to.nodes.begin(), to.nodes.end()},
                                 {from.nodes.begin(), from.nodes.end()}});
    }
    return share;
}

}  // namespace feldspar
