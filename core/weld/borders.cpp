#include "core/weld/borders.h"

#include "core/weld/sides.h"

namespace lastflat {

Loop loop_of(const Faces& faces, std::vector<Index> vertices) {
    Loop loop{std::move(vertices), {}};
    for (std::size_t i = 0; i < loop.size(); ++i) {
        loop.along.push_back(loop.length);
        loop.length += (faces.position(loop.vertex(i + 1)) - faces.position(loop.vertex(i))).norm();
    }
    return loop;
}

std::vector<Loop> border_loops(const Faces& faces) {
    std::map<Index, std::vector<Index>> next;
    for_each_edge(faces.sides(), [&](auto first, auto last) {
        if (last - first == 1) next[first->from()].push_back(first->to());
    });
    std::vector<Loop> loops;
    while (!next.empty()) {
        std::vector<Index> vertices;
        auto at = next.begin();
        const Index begin = at->first;
        bool closed = false;
        while (at != next.end() && !closed) {
            const Index from = at->first, to = at->second.back();
            at->second.pop_back();
            if (at->second.empty()) next.erase(at);
            vertices.push_back(from);
            closed = to == begin;
            at = next.find(to);
        }
        if (closed && vertices.size() > 2) loops.push_back(loop_of(faces, std::move(vertices)));
    }
    return loops;
}

void insert_into_edges(Faces& faces, const Insertions& insertions) {
    std::map<std::pair<Index, Index>, std::size_t> triangle_of;
    const auto file = [&](std::size_t t) {
        for (std::size_t i = 0; i < 3; ++i)
            triangle_of[{faces.triangles[t][i], faces.triangles[t][(i + 1) % 3]}] = t;
    };
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) file(t);
    for (const auto& [edge, inserted] : insertions) {
        const std::size_t t = triangle_of.at(edge);
        const Triangle whole = faces.triangles[t];
        std::size_t corner = 0;
        while (whole[corner] != edge.first) ++corner;
        const Index apex = whole[(corner + 2) % 3];
        Index from = edge.first;
        for (const Index vertex : inserted) {
            faces.triangles.push_back({from, vertex, apex});
            faces.origins.push_back(faces.origins[t]);
            file(faces.triangles.size() - 1);
            from = vertex;
        }
        faces.triangles[t] = {from, edge.second, apex};
        file(t);
    }
}

void rename_vertices(Faces& faces, const std::map<Index, Index>& renamed) {
    for (Index& stands_for : faces.welded_to) {
        if (const auto found = renamed.find(stands_for); found != renamed.end())
            stands_for = found->second;
    }
    faces.rename();
}

}  // namespace lastflat
