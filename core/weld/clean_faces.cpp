#include "core/weld/clean_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/numerics/disjoint_sets.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/weld/merge_vertices.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

bool names_twice(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

void drop_collapsed(Faces& faces, RepairNote& note) {
    faces.keep_if([&](const Triangle& t) {
        if (names_twice(t)) note.at(faces.position(t[0]));
        return !names_twice(t);
    });
}

/// The triangles that have the same three vertices.
struct Repeated {
    std::size_t forward = 0, backward = 0;  ///< by their winding
    bool cancels = false;                   ///< all of them go
    bool met = false;
};

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

/// Whether any two triangles have the same three vertices.
bool has_repetition(const Faces& faces) {
    std::vector<std::size_t> end(faces.positions.size() + 1, 0);  // of those with a least vertex
    for (const Triangle& t : faces.triangles) ++end[at(*std::min_element(t.begin(), t.end())) + 1];
    for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
    const std::vector<std::size_t> begin = end;
    std::vector<std::pair<Index, Index>> others(faces.triangles.size());
    for (const Triangle& triangle : faces.triangles) {
        const Triangle t = sorted(triangle);
        others[end[at(t[0])]++] = {t[1], t[2]};
    }
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
        const auto first = others.begin() + static_cast<std::ptrdiff_t>(begin[v]);
        const auto last = others.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]);
        std::sort(first, last);
        if (std::adjacent_find(first, last) != last) return true;
    }
    return false;
}

/// As many wind one way as the other, and without them no edge is left with an odd number of sides:
/// a wall without thickness, that bounds nothing.
bool bounds_nothing(const Triangle& t, const Repeated& repeated,
                    const std::map<std::pair<Index, Index>, std::size_t>& sides) {
    bool even = repeated.forward == repeated.backward;
    for (const auto& edge : {std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[0], t[2])})
        even = even && sides.at(edge) % 2 == 0;
    return even;
}

/// Walls go, of others one stays. Where most faces are there twice the model is a sheet with two
/// sides.
void drop_repetitions(Faces& faces, RepairNote& note) {
    if (!has_repetition(faces)) return;
    std::map<Triangle, Repeated> all;
    for (const Triangle& t : faces.triangles) {
        const auto least =
            static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
        Repeated& repeated = all[sorted(t)];
        ++(t[(least + 1) % 3] < t[(least + 2) % 3] ? repeated.forward : repeated.backward);
    }
    const bool is_sheet = 4 * all.size() < 3 * faces.triangles.size();
    std::map<std::pair<Index, Index>, std::size_t> sides;
    for (const Side& side : faces.sides()) ++sides[{side.low, side.high}];
    for (auto& [t, repeated] : all) {
        repeated.cancels = !is_sheet && repeated.backward > 0 && bounds_nothing(t, repeated, sides);
    }
    faces.keep_if([&](const Triangle& t) {
        Repeated& repeated = all.at(sorted(t));
        if (!repeated.cancels && !std::exchange(repeated.met, true)) return true;
        note.at(faces.position(t[0]));
        return false;
    });
}

double edge_length(const Faces& faces, const Triangle& t, std::size_t i) {
    return (faces.position(t[(i + 1) % 3]) - faces.position(t[i])).norm();
}

std::size_t longest_side(const Faces& faces, const Triangle& t) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (edge_length(faces, t, i) > edge_length(faces, t, best)) best = i;
    }
    return best;
}

/// As `check_shapes` has it, with room to spare.
bool is_flat(const Faces& faces, const Triangle& t) {
    return !(height_share(faces, t) > 2.0 * tolerance::degenerate_height);
}

/// Joins the ends of nearly zero edges of flat triangles. Whether there were any.
bool join_short_edges(Faces& faces, RepairNote& note) {
    DisjointSets sets(faces.positions.size());
    bool joined = false;
    for (const Triangle& t : faces.triangles) {
        if (!is_flat(faces, t)) continue;
        const double longest = edge_length(faces, t, longest_side(faces, t));
        for (std::size_t i = 0; i < 3; ++i) {
            if (edge_length(faces, t, i) > 4.0 * tolerance::degenerate_height * longest) continue;
            sets.join(t[i], t[(i + 1) % 3]);
            note.at(faces.position(t[i]));
            joined = true;
            break;
        }
    }
    if (!joined) return false;
    for (Index& stands_for : faces.welded_to) stands_for = sets.find(stands_for);
    faces.rename();
    return true;
}

/// Takes a flat triangle out and puts its middle vertex into the longest side's other triangle.
/// Whether there was one; one at a time for each neighbourhood.
bool remove_caps(Faces& faces, RepairNote& note) {
    const auto& sides = faces.sides();
    std::vector<Index> flat;
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        if (is_flat(faces, faces.triangles[t])) flat.push_back(static_cast<Index>(t));
    }
    if (flat.empty()) return false;
    std::vector<bool> touched(faces.triangles.size(), false);
    for (const Index cap : flat) {
        const Triangle t = faces.triangles[static_cast<std::size_t>(cap)];
        const std::size_t i = longest_side(faces, t);
        const Index a = t[i], b = t[(i + 1) % 3], middle = t[(i + 2) % 3];
        const Side wanted{std::min(a, b), std::max(a, b), -1, 0, a < b};
        auto side =
            std::lower_bound(sides.begin(), sides.end(), wanted, [](const Side& x, const Side& y) {
                return x.low != y.low ? x.low < y.low : x.high < y.high;
            });
        for (; side != sides.end() && side->same_edge(wanted) && side->triangle == cap;) ++side;
        if (touched[static_cast<std::size_t>(cap)]) continue;
        const bool has_neighbour = side != sides.end() && side->same_edge(wanted);
        if (has_neighbour && touched[static_cast<std::size_t>(side->triangle)]) continue;
        touched[static_cast<std::size_t>(cap)] = true;
        note.at(faces.position(middle));
        if (!has_neighbour) {  // on the border: it covers nothing
            faces.triangles[static_cast<std::size_t>(cap)] = {a, a, a};
            continue;
        }
        touched[static_cast<std::size_t>(side->triangle)] = true;
        Triangle& neighbour = faces.triangles[static_cast<std::size_t>(side->triangle)];
        const auto corner = static_cast<std::size_t>(side->corner);
        Triangle other = neighbour;
        neighbour[corner] = middle;
        other[(corner + 1) % 3] = middle;
        faces.triangles[static_cast<std::size_t>(cap)] = other;
        faces.origins[static_cast<std::size_t>(cap)] =
            faces.origins[static_cast<std::size_t>(side->triangle)];
    }
    return true;
}

/// Two patches meet along an edge, and wind against each other there.
struct Clash {
    Index a, b;
};

/// Pieces whose borders come as near to each other as those that are stitched are one.
void join_touching(const Faces& faces, DisjointSets& pieces) {
    std::vector<Index> border;
    Points3 positions;
    for_each_edge(faces.sides(), [&](auto first, auto last) {
        if (last - first != 1) return;
        border.push_back(first->from());
        positions.push_back(faces.position(first->from()));
    });
    const auto same = merge_vertices(positions, tolerance::near_border * size_of(faces));
    for (std::size_t i = 0; i < same.size(); ++i) pieces.join(border[i], border[at(same[i])]);
}

/// Per patch, under its representative, whether it is to be turned so that patches wind alike, as
/// the greater part of those that hang together does.
std::vector<bool> patches_to_turn(DisjointSets& patches, const std::vector<Clash>& clashes,
                                  std::size_t count) {
    std::vector<std::size_t> sizes(count, 0);
    for (std::size_t t = 0; t < count; ++t) ++sizes[at(patches.find(static_cast<Index>(t)))];
    std::map<Index, std::set<Index>> against;
    for (const Clash& clash : clashes) {
        const Index a = patches.find(clash.a), b = patches.find(clash.b);
        if (a == b) continue;
        against[a].insert(b);
        against[b].insert(a);
    }
    std::vector<bool> turned(count, false), seen(count, false);
    for (const auto& [seed, neighbours] : against) {
        if (seen[at(seed)]) continue;
        seen[at(seed)] = true;
        std::vector<Index> group{seed};
        std::size_t kept = 0, others = 0;
        for (std::size_t i = 0; i < group.size(); ++i) {
            const Index here = group[i];
            (turned[at(here)] ? others : kept) += sizes[at(here)];
            for (const Index next : against[here]) {
                if (seen[at(next)]) continue;
                seen[at(next)] = true;
                turned[at(next)] = !turned[at(here)];
                group.push_back(next);
            }
        }
        if (others <= kept) continue;
        for (const Index patch : group) turned[at(patch)] = !turned[at(patch)];
    }
    return turned;
}

}  // namespace

void Faces::rename() {
    for (Triangle& t : triangles) {
        for (Index& vertex : t) vertex = welded_to[static_cast<std::size_t>(vertex)];
    }
}

const std::vector<Side>& Faces::sides() const {
    if (known.triangles != triangles) known = {triangles, sides_by_edge(triangles)};
    return known.sides;
}

double size_of(const Faces& faces) {
    Eigen::AlignedBox3d box;
    for (const Triangle& t : faces.triangles) {
        for (const Index v : t) box.extend(faces.position(v));
    }
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

void drop_repeated_faces(Faces& faces, std::vector<Repair>& repairs) {
    RepairNote collapsed, repeated;
    drop_collapsed(faces, collapsed);
    drop_repetitions(faces, repeated);
    collapsed.write(repairs, "faces_dropped", "triangles that name a vertex twice were left out");
    repeated.write(repairs, "duplicate_faces_dropped",
                   "triangles that repeat another were left out");
}

void clean_faces(Faces& faces, std::vector<Repair>& repairs) {
    drop_repeated_faces(faces, repairs);
    RepairNote flat;
    constexpr int most_rounds = 64;  // a cap's neighbour may become a cap
    for (int round = 0; round < most_rounds; ++round) {
        RepairNote silent;
        const bool joined = join_short_edges(faces, flat);
        if (joined) drop_collapsed(faces, silent);
        const bool removed = remove_caps(faces, flat);
        if (removed) drop_collapsed(faces, silent);
        if (!joined && !removed) break;
        drop_repetitions(faces, silent);
    }
    flat.write(repairs, "flat_faces_removed", "triangles without area were taken out");
}

void wind_alike(Faces& faces, std::vector<Repair>& repairs) {
    const std::size_t count = faces.triangles.size();
    const auto& sides = faces.sides();
    DisjointSets patches = patches_of(faces.triangles, sides);
    std::vector<Clash> clashes;
    for_each_edge(sides, [&](auto first, auto last) {
        if (last - first == 2 && first->forward == (first + 1)->forward)
            clashes.push_back({first->triangle, (first + 1)->triangle});
    });
    if (clashes.empty()) return;
    const std::vector<bool> turned = patches_to_turn(patches, clashes, count);
    RepairNote note;
    for (std::size_t t = 0; t < count; ++t) {
        if (!turned[at(patches.find(static_cast<Index>(t)))]) continue;
        Triangle& triangle = faces.triangles[t];
        std::swap(triangle[1], triangle[2]);
        note.at(faces.position(triangle[0]));
    }
    note.write(repairs, "faces_turned",
               "triangles that wound against their neighbours were turned");
}

void drop_strays(Faces& faces, std::vector<Repair>& repairs) {
    DisjointSets pieces(faces.positions.size());
    for (const Triangle& t : faces.triangles) {
        pieces.join(t[0], t[1]);
        pieces.join(t[0], t[2]);
    }
    join_touching(faces, pieces);
    std::map<Index, double> areas;
    for (const Triangle& t : faces.triangles)
        areas[pieces.find(t[0])] += doubled_area_vector(faces, t).norm();
    if (areas.size() < 2) return;
    double largest = 0.0;
    for (const auto& [piece, area] : areas) largest = std::max(largest, area);
    RepairNote note;
    std::set<Index> strays;
    for (const auto& [piece, area] : areas) {
        if (area >= tolerance::stray_area * largest) continue;
        strays.insert(piece);
        note.at(faces.position(piece));
    }
    faces.keep_if([&](const Triangle& t) { return !strays.contains(pieces.find(t[0])); });
    note.write(repairs, "strays_dropped",
               "loose pieces with less than 1 % of the largest one's area were left out");
}

}  // namespace lastflat
