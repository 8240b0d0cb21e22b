"""What buttons need, and what they say while they are grey."""

from .. import display


class NeedsResults:
    """Grey until something has been solved."""

    @classmethod
    def poll(cls, context):
        """Grey without results."""
        if display.has_results(context.scene):
            return True
        cls.poll_message_set("There are no results yet: solve first")
        return False


class NeedsObjectMode:
    """Grey in other modes than Object Mode."""

    @classmethod
    def poll(cls, context):
        """Grey in other modes."""
        if context.mode == "OBJECT":
            return True
        cls.poll_message_set("Leave Edit Mode first (Tab)")
        return False
