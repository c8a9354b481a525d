// What the program does without a server.
#pragma once

#include <filesystem>
#include <optional>

#include "core/sample/sample_last.h"

namespace lastflat::server {

/// Flattens MODEL and writes DIR/result.json, flat.obj, flat.glb and pattern.svg: all of them or
/// none. Returns the exit code: 0 done; 2 bad input, 1 anything else, with a problem document on
/// standard error.
[[nodiscard]] int flatten_command(const std::filesystem::path& model,
                                  const std::optional<std::filesystem::path>& request,
                                  const std::filesystem::path& directory);

/// Prints what the model is and what was mended in it, as `POST /v1/validate` answers. Exit codes
/// as above.
[[nodiscard]] int inspect_command(const std::filesystem::path& model,
                                  const std::optional<std::filesystem::path>& request);

/// Prints where the points and lines of a file, as `POST /v1/jobs/{id}/map` takes them, lie on the
/// pattern or on the last. `flat_obj`: of `flatten`. Exit codes as above.
[[nodiscard]] int map_command(const std::filesystem::path& flat_obj,
                              const std::filesystem::path& points);

/// Writes DIR/last.obj, last.glb and last.request.json. Exit codes as above.
[[nodiscard]] int sample_last_command(const SampleLastOptions& options,
                                      const std::filesystem::path& directory);

}  // namespace lastflat::server
