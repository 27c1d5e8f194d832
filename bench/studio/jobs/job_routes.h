#pragma once

#include "http/routes.h"
#include "jobs/jobs.h"

namespace kerf::bench {

// The jobs of a studio over HTTP. Both must outlive the routes.
//
//     GET  /api/jobs            the list, newest first: Jobs::list()
//     GET  /api/jobs/log?job=7  {"text": what it has said so far}
//     POST /api/jobs/stop       {"job": 7}
//     POST /api/jobs/forget     {"job": 7}: of one that has ended
void add_job_routes(Routes& routes, Jobs& jobs);

/// The number of a job that a page has sent. @throws RequestError 400.
[[nodiscard]] std::size_t job_in(const HttpRequest& request);
[[nodiscard]] std::size_t job_in_query(const HttpRequest& request);

}  // namespace kerf::bench
