"""Cells of a notebook: the same without `await`. `SyncParley` works in a thread of its own."""

# %% open it; `with SyncParley(..) as parley:` is the short form for scripts
from parley.api import SyncParley, person

parley = SyncParley("nursing-home", by=person("Ada"), config={"speed": None, "approval": "ask_first"}).open()
robot = parley.robots[0]

# %% tell it something, and ask
parley.remember("where the spanner is", "The spanner is on the bookshelf.")
print(parley.memories("spanner")[0].data)
print(parley.say(robot, "Where is the spanner?").message)

# %% an order waits for a yes, and the yes counts for what was shown
print(parley.say(robot, "go to the bookshelf").message)
proposal = parley.proposal(robot)
print(proposal.lines)
parley.approve(proposal)
print([each.state for each in parley.settled(robot, timeout_s=60).steps])

# %% stop is at hand whatever happens, and only a person releases it
parley.stop()
parley.reset()

# %% the end
parley.close()
