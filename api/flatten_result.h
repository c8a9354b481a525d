// The result of a flattening, as it stands on the wire. Lengths in mm.
#pragma once

#include <string>

namespace lastflat {
struct FlattenResult;
}

namespace lastflat::api {

/// The body of GET /v1/jobs/{id}/result, by the program of this version. The same result gives the
/// same bytes.
[[nodiscard]] std::string to_json(const FlattenResult& result, const std::string& version);

/// The same without what grows with the mesh: no coordinates, triangles, outlines, fan or layout.
[[nodiscard]] std::string metrics_json(const FlattenResult& result, const std::string& version);

/// The same without what stays while the regions do: no triangles, no ways back to the model,
/// nothing that was found.
[[nodiscard]] std::string moved_json(const FlattenResult& result, const std::string& version);

}  // namespace lastflat::api
