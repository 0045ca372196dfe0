"""What a request may take: sizes, times and memory. `docs/reliability.md` lists them."""

from __future__ import annotations

KIB, MIB, GIB = 1024, 1024**2, 1024**3

QUESTION_BYTES = 1 * MIB  #: of a question's body: four times the longest design, as JSON
JOB_BYTES = 8 * MIB  #: of a job's body; enough for a recorded base motion of about 60 000 rows
SMALL_BYTES = 32 * KIB  #: of a question that is answered with the quick ones: ten times a usual design
FEW_CHANGES = 24  #: to the design of such a question: a page that is used by hand makes fewer
BODIES_BYTES = 64 * MIB  #: of all bodies that arrive at a time, and of all that wait with their jobs
DEPTH = 12  #: of lists and objects within each other in a body
DIGITS = 308  #: of an integer

HEAD_SECONDS = 10.0  #: in which the head of a request must have come
BODY_SECONDS = 60.0  #: in which its body must have come
IDLE_SECONDS = 75  #: after which a connection without a request is closed: browsers keep theirs, and need no new one
SEND_SECONDS = 60.0  #: in which a client must take each part of an answer
START_SECONDS = 120.0  #: in which a process must have started
ANSWER_SECONDS = 20.0  #: of computing for a question
JOB_SECONDS = 900.0  #: of computing for a job
GRACE_SECONDS = 5.0  #: in which a question may end after its client has left; then its process is killed

MEMORY = 1 * GIB  #: of data of a process for jobs, beside what it has at its start; enforced on Linux
QUESTION_MEMORY = 256 * MIB  #: of a process for questions
QUICK = 2  #: processes for questions about designs that were accepted before
CAREFUL = 2  #: processes at most for other questions: new or long designs
MOST_JOBS = 16  #: at once, on a machine with many cores; at least four

# What clients share: one may have as much as it leaves free for the others.
CONNECTIONS = 400  #: open at a time; then those of an address are closed that have waited longest without a request
WAITING = 200  #: questions of a kind, and jobs, that wait for their turn

# What each client may take at once, and in each second after that.
REQUESTS, REQUESTS_A_SECOND = 200, 100  #: those beyond wait
LATE_SECONDS = 3.0  #: for which they wait at most; then they are refused
LONG_BYTES, LONG_BYTES_A_SECOND = 16 * MIB, 4 * MIB  #: of bodies beyond the small ones; what comes faster waits
# What each address may.
OPENINGS, OPENINGS_A_SECOND = 100, 5  #: GET requests without a cookie, as of new pages, that do not wait
NEW_CONNECTIONS, NEW_CONNECTIONS_A_SECOND = 400, 200  #: those beyond are refused
NEW_CLIENTS, NEW_CLIENTS_A_SECOND = 50, 0.2  #: that get a cookie; those beyond are one client together
IPV6_NETWORK = 64  #: bits that are the same in all addresses of one network
