#include "feldspar/model/bands.hpp"

#include <algorithm>
#include <numeric>

#include "feldspar/model/assembly.hpp"

namespace feldspar {
namespace {

// The units that something joins: [first, last].
struct Span {
    std::int32_t first = 0, last = -1;

    bool empty() const { return last < first; }
    void add(std::int32_t unit) {
        if (unit < 0) return;
        first = empty() ? unit : std::min(first, unit);
        last = std::max(last, unit);
    }
    void add(const Span& other) {
        if (other.empty()) return;
        add(other.first);
        add(other.last);
    }
};

struct Spans {
    std::vector<Span> contacts;  // of each pack of contacts
    std::vector<Span> plates;    // of each body that is a plate
    Span platen;                 // of the loading platen, if it is a row of nodes
};

// The unit of a body: packs of grains first, rigid bodies behind them; -1 of a loose one.
std::int32_t unit_of(const Assembly& assembly, int body) {
    if (assembly.bodies[body].kind == BodyKind::rigid) return static_cast<std::int32_t>(assembly.packs.grains.size()) + body;
    return assembly.packs.pack_of_body[body];
}

int plate_of(const Assembly& assembly, const ContactPack& pack) {
    const Contact& first = assembly.contacts[pack.first_contact];
    return first.plate ? first.b.body : -1;
}

// Packs of contacts at a plate join whatever the plate touches.
std::vector<Span> spans_of_contact_packs(const Assembly& assembly) {
    const std::vector<ContactPack>& packs = assembly.packs.contacts;
    std::vector<Span> spans(packs.size()), of_plates(assembly.bodies.size());
    for (std::size_t p = 0; p < packs.size(); ++p) {
        for (int c = packs[p].first_contact; c < packs[p].first_contact + packs[p].lanes; ++c) {
            spans[p].add(unit_of(assembly, assembly.contacts[c].a.body));
            spans[p].add(unit_of(assembly, assembly.contacts[c].b.body));
        }
        if (const int plate = plate_of(assembly, packs[p]); plate >= 0) of_plates[plate].add(spans[p]);
    }
    for (std::size_t p = 0; p < packs.size(); ++p)
        if (const int plate = plate_of(assembly, packs[p]); plate >= 0) spans[p] = of_plates[plate];
    return spans;
}

// Orders the packs of contacts by the place of what they join, in which order assemble() makes them; those of contacts made later
// come to where they are.
void order_contact_packs(Assembly& assembly, std::vector<Span>& spans) {
    std::vector<ContactPack>& packs = assembly.packs.contacts;
    std::vector<std::int32_t> place;
    for (std::size_t p = 0; p < packs.size(); ++p) {
        const Contact& first = assembly.contacts[packs[p].first_contact];
        place.push_back(first.plate ? spans[p].first + spans[p].last
                                    : unit_of(assembly, first.a.body) + unit_of(assembly, first.b.body));
    }
    std::vector<std::size_t> order(packs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) { return place[l] < place[r]; });
    const auto reorder = [&](auto& all) {
        auto ordered = all;
        for (std::size_t i = 0; i < order.size(); ++i) ordered[i] = all[order[i]];
        all = std::move(ordered);
    };
    reorder(packs);
    reorder(spans);
}

// Where bands begin, and the end of the last one: units, and packs of contacts.
struct Cuts {
    std::vector<std::int32_t> units{0}, contacts{0};
};

// As narrow as the spans allow.
Cuts cut(std::int32_t units, const std::vector<Span>& spans, const Span& platen_row) {
    // Packs of contacts up to behind[u] begin before unit u; reach[q] is behind all units that one of the first q packs joins.
    std::vector<std::int32_t> behind(static_cast<std::size_t>(units) + 1, 0), reach{0};
    for (std::size_t q = 0; q < spans.size(); ++q) {
        if (!spans[q].empty()) behind[spans[q].first + 1] = static_cast<std::int32_t>(q) + 1;
        reach.push_back(std::max(reach.back(), spans[q].last + 1));
    }
    std::partial_sum(behind.begin(), behind.end(), behind.begin(), [](std::int32_t l, std::int32_t r) { return std::max(l, r); });
    Cuts cuts;
    while (cuts.units.back() < units) {
        const std::int32_t begin = cuts.units.back();
        cuts.contacts.push_back(std::max(cuts.contacts.back(), behind[begin]));
        const std::int32_t behind_row = !platen_row.empty() && platen_row.first < begin ? platen_row.last + 1 : 0;
        cuts.units.push_back(std::max({begin + 1, reach[cuts.contacts.back()], behind_row}));
    }
    if (units == 0) cuts = {{0, 0}, {0, 0}};
    cuts.contacts.back() = static_cast<std::int32_t>(spans.size());
    return cuts;
}

// Bytes in five bands, in seven, ...: two a step, and one; `begin` is of the units of each band, and the end of the last.
std::vector<double> windows(double bytes, const std::vector<std::int32_t>& begin) {
    constexpr int kMostSteps = 10;  // a block of steps
    std::vector<double> all;
    for (std::size_t bands = 5; bands <= 2 * kMostSteps + 1 && bands < begin.size(); bands += 2) {
        std::int32_t widest = 0;
        for (std::size_t b = bands; b < begin.size(); ++b) widest = std::max(widest, begin[b] - begin[b - bands]);
        all.push_back(widest * bytes / begin.back());
    }
    return all;
}

// That a step streams through, about.
double bytes_of_a_step(const Assembly& assembly) {
    const Packs& packs = assembly.packs;
    const auto bytes = [](const auto& v) { return static_cast<double>(v.size() * sizeof(v[0])); };
    constexpr double kBytesOfAPack =
        sizeof(ContactPack) + kMostLanes * (3 * sizeof(double) + 2 * sizeof(std::uint32_t));  // offset, tangent, lines
    const double contacts = kBytesOfAPack * static_cast<double>(packs.contacts.size());
    const double rigid = packs.rigid_end > 0 ? bytes(packs.rigid) + bytes(packs.rigid_forces) : 0.0;
    return 5.0 * bytes(assembly.nodes.velocity) + bytes(assembly.nodes.mass) + bytes(packs.scale) + bytes(packs.lines) +
           bytes(packs.inverse_cross) + 4.0 * bytes(packs.along) + contacts + rigid;
}

}  // namespace

int Bands::steps(int threads) const {
    const auto most = [&](double cache_bytes) {
        return 1 +
               static_cast<int>(std::upper_bound(window_bytes.begin(), window_bytes.end(), cache_bytes) - window_bytes.begin());
    };
    if (const int own = most(kOwnCacheBytes); threads == 1 && own > 1 && bytes > kOwnCacheBytes) return own;
    return bytes > kSharedCacheBytes ? most(kSharedCacheBytes) : 1;
}

void cut_into_bands(Assembly& assembly) {
    Packs& packs = assembly.packs;
    std::vector<Span> spans = spans_of_contact_packs(assembly);
    order_contact_packs(assembly, spans);
    const auto grains = static_cast<std::int32_t>(packs.grains.size()), units = grains + packs.rigid_end;
    Span row;  // with nodes of the fixtures that load
    int loading = 0;
    for (const Fixture& fixture : assembly.fixtures) {
        if (!fixture.moves()) continue;
        ++loading;
        for (const int node : fixture.nodes) row.add(pack_of_node(packs, node));
    }
    const auto is_plate = [&](int body) { return assembly.bodies[body].kind == BodyKind::plate; };
    const bool all_have_units =
        std::all_of(packs.loose_bodies.begin(), packs.loose_bodies.end(), is_plate);  // or a band by its contacts
    // The work of what loads is taken where one band ends: several fixtures may lie in several bands, so there is only one then.
    const Cuts cuts =
        all_have_units && loading <= 1 ? cut(units, spans, row) : Cuts{{0, units}, {0, static_cast<std::int32_t>(spans.size())}};

    Bands& bands = packs.bands;
    bands = {};
    bands.ranges.resize(cuts.units.size() - 1);
    std::vector<int> band_of(assembly.bodies.size(), 0);  // of plates: that of the first contacts
    for (std::size_t b = bands.ranges.size(); b-- > 0;) {
        PackRanges& band = bands.ranges[b];
        band.contacts = {cuts.contacts[b], cuts.contacts[b + 1]};
        band.grains = {std::min(cuts.units[b], grains), std::min(cuts.units[b + 1], grains)};
        band.rigid = {std::max(0, cuts.units[b] - grains), std::max(0, cuts.units[b + 1] - grains)};
        for (int p = band.contacts.begin; p < band.contacts.end; ++p)
            if (const int plate = plate_of(assembly, packs.contacts[p]); plate >= 0) band_of[plate] = static_cast<int>(b);
        if (bands.platen == 0 && row.last >= cuts.units[b]) bands.platen = static_cast<int>(b);
    }
    for (const Fixture& fixture : assembly.fixtures)
        if (fixture.moves() && fixture.plate >= 0) bands.platen = band_of[fixture.plate];
    std::stable_sort(packs.loose_bodies.begin(), packs.loose_bodies.end(), [&](int l, int r) { return band_of[l] < band_of[r]; });
    for (int i = 0; i < std::ssize(packs.loose_bodies); ++i) {
        IndexRange& range = bands.ranges[band_of[packs.loose_bodies[i]]].loose_bodies;
        range = {range.begin == range.end ? i : range.begin, i + 1};
    }
    bands.bytes = bytes_of_a_step(assembly);
    bands.window_bytes = windows(bands.bytes, cuts.units);
}

}  // namespace feldspar
