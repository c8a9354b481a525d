// What the program does without a server.
#pragma once

#include <filesystem>
#include <optional>

#include "core/sample/sample_last.h"
#include "server/cli/complaint.h"

namespace lastflat::server {

/// Flattens MODEL and writes DIR/result.json, flat.obj, flat.glb and pattern.svg: all of them or
/// none. Prints what came of it, to people as a table, to programs as `GET /v1/jobs/{id}/metrics`
/// answers. Returns the exit code: 0 done; else as `complain`.
[[nodiscard]] int flatten_command(const std::filesystem::path& model,
                                  const std::optional<std::filesystem::path>& request,
                                  const std::filesystem::path& directory, Audience audience);

/// Prints what the model is and what was mended in it, as `POST /v1/validate` answers. Exit codes
/// as above.
[[nodiscard]] int inspect_command(const std::filesystem::path& model,
                                  const std::optional<std::filesystem::path>& request,
                                  Audience audience);

/// Prints where the points and lines of a file, as `POST /v1/jobs/{id}/map` takes them, lie on the
/// pattern or on the last. `flat_obj`: of `flatten`. Exit codes as above.
[[nodiscard]] int map_command(const std::filesystem::path& flat_obj,
                              const std::filesystem::path& points, Audience audience);

/// Writes DIR/last.obj, last.glb and last.request.json. Exit codes as above.
[[nodiscard]] int sample_last_command(const SampleLastOptions& options,
                                      const std::filesystem::path& directory, Audience audience);

}  // namespace lastflat::server
