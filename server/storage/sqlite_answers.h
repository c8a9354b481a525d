// Results that answer a question again: the same model, the same request, the same program.
#pragma once

#include "server/storage/sqlite_rows.h"

namespace lastflat::server {

void note_question(SqliteConnection& connection, JobNumber job, const NewJob& asked);
void forget_question(SqliteConnection& connection, JobNumber job);

/// The latest job of the same owner that answers the question and still has its result. Nothing if
/// the job asks to be run.
[[nodiscard]] std::optional<JobNumber> answer_to(SqliteConnection& connection, const NewJob& asked);

/// A queued job has succeeded with the other one's result.
void give_answer(SqliteConnection& connection, const NewJob& asked, JobNumber answer);

}  // namespace lastflat::server
