#include "server/storage/sqlite_answers.h"

namespace lastflat::server {

void note_question(SqliteConnection& connection, JobNumber job, const NewJob& asked) {
    if (asked.question.empty()) return;
    Query(connection.prepared("INSERT INTO questions VALUES (?, ?, ?)"))
        .bind(job, asked.owner, asked.question)
        .run();
}

void forget_question(SqliteConnection& connection, JobNumber job) {
    Query(connection.prepared("DELETE FROM questions WHERE seq = ?")).bind(job).run();
}

std::optional<JobNumber> answer_to(SqliteConnection& connection, const NewJob& asked) {
    if (asked.fresh || asked.question.empty()) return std::nullopt;
    Query query(connection.prepared(
        "SELECT q.seq FROM questions q JOIN jobs j ON j.seq = q.seq WHERE q.owner = ? AND "
        "q.question = ? AND j.state = 'succeeded' AND j.result <> '' ORDER BY q.seq DESC LIMIT 1"));
    if (!query.bind(asked.owner, asked.question).next()) return std::nullopt;
    return query.number(0);
}

void give_answer(SqliteConnection& connection, const NewJob& asked, JobNumber answer) {
    auto row = find_row(connection, asked.owner, asked.id);
    if (!row) throw StoreError("the job " + asked.id + " is gone");
    change_state(connection, *row, JobState::succeeded);
    Query(connection.prepared("UPDATE jobs SET (result, parts, result_bytes) = "
                              "(SELECT result, parts, result_bytes FROM jobs WHERE seq = ?2) "
                              "WHERE seq = ?1"))
        .bind(row->seq, answer)
        .run();
}

}  // namespace lastflat::server
