"""What a request may take: sizes, times and memory. `docs/reliability.md` lists them."""

from __future__ import annotations

KIB, MIB, GIB = 1024, 1024**2, 1024**3

QUESTION_BYTES = 1 * MIB  #: of a question's body: four times the longest design, as JSON
JOB_BYTES = 8 * MIB  #: of a job's body; enough for a recorded base motion of about 60 000 rows
SMALL_BYTES = 32 * KIB  #: of a question that is answered with the quick ones: ten times a usual design
BODIES_BYTES = 64 * MIB  #: of all bodies that arrive at a time, and of all that wait with their jobs
DEPTH = 12  #: of lists and objects within each other in a body
DIGITS = 308  #: of an integer

HEAD_SECONDS = 10.0  #: in which the head of a request must have come
BODY_SECONDS = 60.0  #: in which its body must have come
SEND_SECONDS = 60.0  #: in which a client must take each part of an answer
START_SECONDS = 120.0  #: in which a process must have started
ANSWER_SECONDS = 20.0  #: of computing for a question
JOB_SECONDS = 900.0  #: of computing for a job
GRACE_SECONDS = 0.5  #: in which a question may end after its client has left; then its process is killed

MEMORY = 1 * GIB  #: of data of a process that computes, beside what it has at its start; enforced on Linux
QUICK = 2  #: processes for questions about designs that were accepted before
CAREFUL = 2  #: processes at most for other questions: new or long designs
MOST_JOBS = 16  #: at once, on a machine with many cores; at least four

CONNECTIONS = 400  #: open at a time; then those are closed that have waited longest without a request
WAITING = 200  #: questions of a kind, and jobs, that wait for their turn
