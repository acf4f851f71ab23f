"""The sentences about callbacks of services, each with a callback that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported, to_look_at

SOURCE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.create_service(SetBool, "/pause", self.pause)

    def pause(self, {parameters}):{look}
        {body}

rclpy.spin(Driver())  # crashed
"""
MUST = "The callback of a service must return its response."


@pytest.mark.parametrize(
    ("parameters", "body", "error", "words"),
    [
        (
            "response, request",
            "self.on = request.data",
            "AttributeError: 'SetBool_Response' object has no attribute 'data'",
            "pause gets the request first, and the response second.",
        ),
        (
            "request, response",
            "self.on = request.data",
            "AttributeError: 'SetBool_Response' object has no attribute 'x'",
            "",
        ),
        ("response, request", "self.on = request.data", "AttributeError: 'Driver' object has no attribute 'data'", ""),
        ("request, response", "response.success = True", "TypeError", f"pause returns nothing. {MUST}"),
        ("request, response", "return", "TypeError", f"pause returns nothing. {MUST}"),
        ("request, response", "return True", "TypeError", f"pause returns True. {MUST}"),
        ("request, response", 'return True, "ok"', "TypeError", f"pause returns a tuple. {MUST}"),
        ("request, response", 'return [True, "ok"]', "TypeError", f"pause returns a list. {MUST}"),
        ("request, response", 'return {"success": True}', "TypeError", f"pause returns a dictionary. {MUST}"),
        ("request, response", "return request", "TypeError", f"pause returns the request (request). {MUST}"),
        (
            "request, response",
            "return SetBool.Response",
            "TypeError",
            f"pause returns the class SetBool.Response instead of an object. {MUST}",
        ),
        ("request, response", "return SetBool.Response()", "TypeError", ""),
        ("request, response", "return self.Response", "TypeError", ""),
        ("request, response", "if request.data:\n            return SetBool.Response", "TypeError", ""),
        (
            "request, response",
            "if request.data:\n            return self.answer()\n        return SetBool.Response",
            "TypeError",
            "",
        ),
        ("request, response", "return SetBool.Response", "TypeError: bad", ""),
        ("request, response", "return response", "TypeError", ""),
        ("request, response", "return True", 'TypeError: can only concatenate str (not "int") to str', ""),
        ("request, response", "response.success = True", "TypeError: 'int' object is not callable", ""),
    ],
)
def test_a_callback_of_a_service_is_blamed_only_for_its_own_error(
    parameters: str, body: str, error: str, words: str
) -> None:
    source = SOURCE.format(parameters=parameters, body=body, look="  # look" if words else "")
    found = reported(source, error)
    own = " gets the request first" in found.cause or MUST in found.cause
    assert (found.cause if own else "", found.line) == (words, to_look_at(source))


SPIN = "rclpy.spin(Driver())"
LAMBDA = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.create_service(SetBool, "/pause", {callback})

    def right(self, request, response):
        return response

    def wrong(self, request, response):
        response.success = True

{line}  # crashed
"""


@pytest.mark.parametrize(
    ("callback", "error", "line", "told"),
    [
        ("lambda request, response: None", "TypeError", SPIN, f"This lambda returns no response. {MUST}"),
        ("lambda request, response: (True, 'ok')", "TypeError", SPIN, f"This lambda returns no response. {MUST}"),
        (
            "lambda request, response: self.wrong(request, response)",
            "TypeError",
            SPIN,
            f"wrong has no return statement with a value, so it returns None. {MUST}",
        ),
        ("lambda request, response: self.right(request, response)", "TypeError", SPIN, ""),
        ("lambda request, response: response", "TypeError", SPIN, ""),
        ("lambda request, response: None", "TypeError: bad", SPIN, ""),
        ("lambda request, response: None", "TypeError", "client.call_async(Spawn.Request)", ""),
        ("wrong", "TypeError", "client.call_async(Spawn.Request)", ""),
        ("pause", "TypeError", SPIN, ""),
    ],
)
def test_a_lambda_must_return_the_response(callback: str, error: str, line: str, told: str) -> None:
    found = reported(LAMBDA.format(callback=callback, line=line), error)
    assert found.cause == told if told else MUST not in found.cause, found
